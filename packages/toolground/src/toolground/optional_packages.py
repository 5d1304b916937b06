"""The packages of the optional extras."""

from importlib import import_module
from types import ModuleType

from .errors import MissingExtra


def required(package: str, what: str, extra: str) -> ModuleType:
    """A package, or a module of one, that an extra installs.

    Args:
        what: needs it, as the message says.
        extra: that installs it, as "fmuloop[cluster]".

    Raises:
        MissingExtra: it is not installed.
    """
    try:
        return import_module(package)
    except ImportError as error:
        name = extra.partition("[")[2].rstrip("]")
        raise MissingExtra(
            f"{what} needs the package {package.partition('.')[0]}: install the extra `{name}`, "
            f"as in pip install '{extra}'"
        ) from error

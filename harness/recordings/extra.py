"""The packages of the optional extra, which read what is no text."""

from importlib import import_module
from types import ModuleType

from ..errors import MissingExtra


def required(package: str, kind: str) -> ModuleType:
    """The package that reads files of a kind.

    Raises:
        MissingExtra: it is not installed.
    """
    try:
        return import_module(package)
    except ImportError as error:
        raise MissingExtra(
            f"reading {kind} needs the package {package.partition('.')[0]}: "
            "install the extra `recordings`, as in pip install 'driveline-damping[recordings]'"
        ) from error

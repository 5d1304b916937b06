"""The files of the archive."""

from collections.abc import Mapping
from importlib.metadata import version
from typing import NamedTuple

from ...base.errors import DrivelineError
from ...cosimulation.wiring import Fit
from ...manoeuvres.manoeuvre import Manoeuvre
from . import mastersim
from .parameter_sets import parameter_set
from .signal_dictionary import dictionary
from .structure import DICTIONARY, structure
from .variables import require_no_conversion, values


class Variant(NamedTuple):
    """The loop with one plant.

    Attributes:
        fitted: with its source, see `harness.exchange.ssp.loop_with_source`.
        given: `instance.parameter` -> value.
    """

    fitted: Fit
    given: Mapping[str, float]


DEFAULT = "SystemStructure.ssd"
"""What tools open that know no variants."""


def package(variants: Mapping[str, Variant], manoeuvre: Manoeuvre) -> dict[str, bytes]:
    """The content of the files by their names in the archive.

    Args:
        variants: by their names, the default first.

    Raises:
        DrivelineError: an FMU needs a conversion of units; two FMUs have the same file name.
    """
    files: dict[str, bytes] = {}
    for number, (name, variant) in enumerate(variants.items()):
        require_no_conversion(variant.fitted)
        for path, content in _files(name, variant, manoeuvre, DEFAULT if number == 0 else f"{name}.ssd").items():
            if files.setdefault(path, content) != content and path != DICTIONARY:
                raise DrivelineError(f"two files are to be {path} in the archive; rename one of the FMUs")
    return files


def _files(name: str, variant: Variant, manoeuvre: Manoeuvre, ssd: str) -> dict[str, bytes]:
    tool, fitted = f"driveline-damping {version('driveline-damping')}", variant.fitted
    found = values(fitted, variant.given)
    sets = {i: f"resources/{i}_{interface.path.stem}.ssv" for i, interface in fitted.interfaces.items()}
    description = f"{manoeuvre.description}, {name}"
    return {
        ssd: structure(name, description, tool, fitted, sets, manoeuvre.duration),
        DICTIONARY: dictionary(fitted, tool),
        **{path: parameter_set(fitted, tool, {"": found[instance]}) for instance, path in sets.items()},
        f"resources/{name}.ssv": parameter_set(fitted, tool, {f"{i}.": every for i, every in found.items()}),
        **{f"resources/{one.path.name}": one.path.read_bytes() for one in fitted.interfaces.values()},
        f"{mastersim.FOLDER}/{name}.msim": mastersim.project(fitted, found, manoeuvre.duration),
    }

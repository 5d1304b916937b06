"""The files of the archive: the structure, parameter sets (SSV), the FMUs."""

from collections.abc import Mapping, Sequence
from importlib.metadata import version
from typing import NamedTuple

from fmuloop.wiring import Fit
from toolground.collected_warnings import warn_once
from toolground.errors import UserError

from ...manoeuvres.manoeuvre import Manoeuvre
from . import mastersim, variables
from .structure import structure
from .variables import Value, conversion, typed_element, units, values
from .xml import Element, document, element


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
        UserError: two FMUs have the same file name.
    """
    files: dict[str, bytes] = {}
    for number, (name, variant) in enumerate(variants.items()):
        for path, content in _files(name, variant, manoeuvre, DEFAULT if number == 0 else f"{name}.ssd").items():
            if files.setdefault(path, content) != content:
                raise UserError(f"two files are to be {path} in the archive; rename one of the FMUs")
    return files


def _files(name: str, variant: Variant, manoeuvre: Manoeuvre, ssd: str) -> dict[str, bytes]:
    tool, fitted = f"driveline-damping {version('driveline-damping')}", variant.fitted
    numbers = values(fitted, variant.given)
    sets = {i: f"resources/{i}_{interface.path.stem}.ssv" for i, interface in fitted.interfaces.items()}
    description = f"{manoeuvre.description}, {name}"
    project = f"{mastersim.FOLDER}/{name}.msim"
    if converted := [c.source for c in fitted.system.connections if conversion(fitted, c) != 1.0]:
        warn_once(
            f"{', '.join(converted)}: converted to another unit by a LinearTransformation, which libcosim and ecos "
            "apply, FMPy and OMSimulator leave out; there is no project of MasterSim"
        )
    if is_2 := variables.version(fitted) == "2.0":
        warn_once(
            "an FMU is of FMI 3.0, so the package is of SSP 2.0, which FMPy, libcosim, ecos and MasterSim do not read; "
            "there is no project of MasterSim"
        )
    return {
        ssd: structure(name, description, tool, fitted, sets, manoeuvre.duration),
        **{path: parameter_set(fitted, tool, {"": numbers[instance]}) for instance, path in sets.items()},
        f"resources/{name}.ssv": parameter_set(fitted, tool, {f"{i}.": every for i, every in numbers.items()}),
        **{f"resources/{interface.path.name}": interface.path.read_bytes() for interface in fitted.interfaces.values()},
        **({} if converted or is_2 else {project: mastersim.project(fitted, numbers, manoeuvre.duration)}),
    }


NAME = "start"
"""Of the parameter sets; ecos is told which are to be taken by it."""


def parameter_set(fitted: Fit, tool: str, values: Mapping[str, Sequence[Value]]) -> bytes:
    """The file of a parameter set.

    Args:
        tool: that made it.
        values: what stands before the names, such as "" or "plant.", -> parameters.
    """
    rows = [_parameter(prefix, value) for prefix, every in values.items() for value in every]
    names = [value.unit for every in values.values() for value in every]
    return document(
        element(
            "ssv:ParameterSet",
            {"version": variables.version(fitted), "name": NAME, "generationTool": tool},
            [element("ssv:Parameters", children=rows), *units("ssv", fitted, names)],
        )
    )


def _parameter(prefix: str, value: Value) -> Element:
    described = {"description": value.description} if value.description else {}
    content = typed_element("ssv", value.type, value.fmi, value.unit, value.value)
    return element("ssv:Parameter", {"name": f"{prefix}{value.name}", **described}, [content])

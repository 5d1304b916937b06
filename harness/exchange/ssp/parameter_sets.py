"""Parameter sets (SSV): one for each FMU, which the structure binds to it, and all of them in one file."""

from collections.abc import Mapping, Sequence

from ...cosimulation.wiring import Fit
from .variables import Value, typed, units
from .xml import VERSION, Element, document, element

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
            {"version": VERSION, "name": NAME, "generationTool": tool},
            [element("ssv:Parameters", children=rows), *units("ssv", fitted, names)],
        )
    )


def _parameter(prefix: str, value: Value) -> Element:
    described = {"description": value.description} if value.description else {}
    content = typed("ssv", value.type, value.unit, value.value)
    return element("ssv:Parameter", {"name": f"{prefix}{value.name}", **described}, [content])

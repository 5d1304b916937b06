"""What an SSP says of the variables of the FMUs: their types, units and values."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from fmpy.model_description import BaseUnit, ModelVariable

from fmuloop.interface import type_of, unit_of
from fmuloop.system import Connection, System
from fmuloop.wiring import Fit

from .xml import Element, element

NUMBERS = ("Real", "Integer")


class Value(NamedTuple):
    """Of a parameter.

    Attributes:
        name: in its FMU.
        type: "Real", "Integer" or "Boolean".
        fmi: of its FMU.
        unit: None for none.
    """

    name: str
    type: str
    value: float | int | bool
    unit: str | None
    description: str | None
    fmi: int


def values(fitted: Fit, assigned: Mapping[str, float]) -> dict[str, list[Value]]:
    """The parameters of the FMUs by their instances: all numbers, given or as they start, and what else is given."""
    values_of: dict[str, list[Value]] = {instance: [] for instance in fitted.interfaces}
    for instance, interface in fitted.interfaces.items():
        for ours, variable in interface.variables.items():
            if variable.causality != "parameter":
                continue
            name, kind = f"{instance}.{ours}", type_of(variable)
            start = variable.start if kind in NUMBERS else None
            value = assigned[name] / _factor(fitted, name) if name in assigned else start
            if value is not None:
                as_typed = {"Real": float, "Integer": int, "Boolean": bool}[kind](value)
                own = as_it_is(fitted, name)
                values_of[instance].append(
                    Value(str(own.name), kind, as_typed, unit_of(own), own.description, interface.fmi)
                )
    return values_of


def their_name(system: System, name: str) -> str:
    """What the FMU calls a variable `instance.variable` of the loop."""
    return system.mapping.get(name, name.partition(".")[2])


def as_it_is(fitted: Fit, name: str) -> ModelVariable:
    """The variable of the FMU, with its own name and unit, behind `instance.variable` of the loop."""
    theirs = their_name(fitted.system, name)
    described = fitted.interfaces[name.partition(".")[0]].description
    return next(variable for variable in described.modelVariables if variable.name == theirs)


def conversion(fitted: Fit, connection: Connection) -> float:
    """What the values of the output are multiplied by to be in the unit of the input."""
    return _factor(fitted, connection.source) / _factor(fitted, connection.target)


def _factor(fitted: Fit, name: str) -> float:
    instance, _, variable = name.partition(".")
    return fitted.interfaces[instance].factors.get(variable, 1.0)


def version(fitted: Fit) -> str:
    """Of the standard, the first that knows all the FMUs: most tools refuse 2.0."""
    return "2.0" if any(interface.fmi == 3 for interface in fitted.interfaces.values()) else "1.0"


OF_FMI3 = {"Real": "Float64", "Integer": "Int32"}
"""What SSP 2.0 calls the types of FMUs of FMI 3.0."""


def typed_element(prefix: str, kind: str, fmi: int, unit: str | None, value: object = None) -> Element:
    """The element of a type, such as `ssc:Real`, with its unit and with a value if there is one."""
    attributes = {} if value is None else {"value": value}
    name = OF_FMI3.get(kind, kind) if fmi == 3 else kind
    return element(f"{prefix}:{name}", attributes | ({"unit": unit} if kind == "Real" and unit else {}))


def units(prefix: str, fitted: Fit, names: Iterable[str | None]) -> list[Element]:
    """The definitions of the units of these names, as the FMUs give them, in their order."""
    bases = {
        unit.name: unit.baseUnit
        for interface in fitted.interfaces.values()
        for unit in interface.description.unitDefinitions
    }
    used = sorted({name for name in names if name})
    elements = [element("ssc:Unit", {"name": name}, [_base(bases.get(name))]) for name in used]
    return [element(f"{prefix}:Units", children=elements)] if elements else []


def _base(unit: BaseUnit | None) -> Element:
    names = ("kg", "m", "s", "A", "K", "mol", "cd", "rad", "factor", "offset")
    usual = BaseUnit()
    exponents = {name: getattr(unit or usual, name) for name in names}
    return element("ssc:BaseUnit", {name: value for name, value in exponents.items() if value != getattr(usual, name)})


def outputs(fitted: Fit) -> dict[str, ModelVariable]:
    """`instance.variable` -> numbers and truth values that the FMUs put out; enumerations stop libcosim."""
    return {
        f"{instance}.{name}": variable
        for instance, interface in fitted.interfaces.items()
        for name, variable in interface.variables.items()
        if variable.causality == "output" and variable.type in (*NUMBERS, "Boolean")
    }

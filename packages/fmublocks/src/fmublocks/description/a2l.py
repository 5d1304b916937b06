"""An ASAM A2L description (ASAP2 1.7.1) of a block in memory: what can be calibrated and measured, and where.

Names, units, limits and meanings are those of the declaration that all else comes from.
"""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from ..block.declaration import Enumeration
from ..block.types import Block
from ..fmu import Fmu
from .variables import Variable, interface

CALIBRATION = {
    "tunable": ("Calibration", "what can be turned while the controller runs"),
    "fixed": ("Fixed", "what is set before the start: the car, what counters stop at"),
}
"""Groups of parameters by their variability."""


class Number(NamedTuple):
    """How numbers lie in memory.

    Attributes:
        name: of their type in A2L.
        size: in bytes.
        largest: of all.
    """

    name: str
    size: int
    largest: float


SINGLE = Number("FLOAT32_IEEE", 4, (2.0 - 2.0**-23) * 2.0**127)
DOUBLE = Number("FLOAT64_IEEE", 8, (2.0 - 2.0**-52) * 2.0**1023)


class Item(NamedTuple):
    """A variable in memory.

    Attributes:
        address: in bytes.
        link: where it lies by the linker; "" where the address is all that is known.
    """

    variable: Variable
    address: int
    link: str = ""


FILE = """\
ASAP2_VERSION 1 71

/begin PROJECT {name} "{description}"
  /begin MODULE {name} "{description}"

    /begin MOD_COMMON ""
      BYTE_ORDER MSB_LAST
      ALIGNMENT_{number.name} {number.size}
    /end MOD_COMMON

    /begin RECORD_LAYOUT real
      FNC_VALUES 1 {number.name} ROW_DIR DIRECT
    /end RECORD_LAYOUT

{blocks}

  /end MODULE
/end PROJECT
"""

CHARACTERISTIC = """\
    /begin CHARACTERISTIC {name} "{meaning}"
      VALUE 0x{address:08X} real 0 {conversion} {low!r} {high!r}{link}
    /end CHARACTERISTIC"""

MEASUREMENT = """\
    /begin MEASUREMENT {name} "{meaning}"
      {number.name} {conversion} 0 0 {low!r} {high!r}
      ECU_ADDRESS 0x{address:08X}{link}
    /end MEASUREMENT"""

UNIT = """\
    /begin COMPU_METHOD {name} "in {unit}"
      IDENTICAL "%12.6" "{unit}"
    /end COMPU_METHOD"""

WORDS = """\
    /begin COMPU_METHOD {name} "{meaning}"
      TAB_VERB "%1.0" ""
      COMPU_TAB_REF {name}_words
    /end COMPU_METHOD

    /begin COMPU_VTAB {name}_words "{meaning}" TAB_VERB {count}
{rows}
    /end COMPU_VTAB"""

GROUP = """\
    /begin GROUP {name} "{meaning}"
      ROOT
      /begin {kind}
        {members}
      /end {kind}
    /end GROUP"""


GROUPS = {"input": "Inputs", "output": "Outputs", "local": "States"}
"""Of what is measured, by causality."""


def description(fmu: Fmu, items: Iterable[Item], number: Number, protocol: str = "") -> str:
    """The A2L file of a block.

    Args:
        items: each variable where it lies. Parameters that are real numbers can be calibrated, all others measured.
        protocol: settings of XCP, as A2L; "" where there are none.
    """
    items = list(items)
    variables = [item.variable for item in items]
    blocks = [*([protocol] if protocol else []), *_conversions(variables)]
    blocks += [_described(item, number) for item in items]
    for variability, (name, meaning) in CALIBRATION.items():
        members = [v for v in variables if v.variability == variability and _is_calibrated(v)]
        blocks += [_group(name, meaning, "REF_CHARACTERISTIC", members)] if members else []
    for causality, name in GROUPS.items():
        members = [v for v in variables if v.causality == causality]
        blocks += [_group(name, f"{name.lower()} of {fmu.name}", "REF_MEASUREMENT", members)] if members else []
    about = {"name": fmu.name, "description": fmu.block.description, "number": number}
    return FILE.format(**about, blocks="\n\n".join(blocks))


def in_order(block: Block, first: dict[str, int], number: Number) -> Iterator[Item]:
    """The variables of a block, which lie one after the other in a record for each causality.

    Args:
        first: addresses of the records, by causality.
    """
    variables = interface(block)
    for causality, address in first.items():
        members = [v for v in variables if v.causality == causality]
        yield from (Item(variable, address + number.size * k) for k, variable in enumerate(members))


def _is_calibrated(variable: Variable) -> bool:
    return variable.causality == "parameter" and variable.fmi_type == "Real"


def _described(item: Item, number: Number) -> str:
    variable, largest = item.variable, number.largest
    low, high = (min(max(float(bound), -largest), largest) for bound in variable.bounds())
    text = CHARACTERISTIC if _is_calibrated(variable) else MEASUREMENT
    return text.format(
        name=variable.name,
        meaning=_quoted(variable.declaration.description),
        address=item.address,
        conversion=_conversion(variable),
        low=low,
        high=high,
        number=number,
        link=f"\n      SYMBOL_LINK {item.link}" if item.link else "",
    )


def _conversion(variable: Variable) -> str:
    """Name of the conversion of a variable: of its words, its unit, or of none."""
    if isinstance(variable.declaration, Enumeration):
        return variable.declaration.name
    return "".join(c if c.isalnum() else "_" for c in f"in_{variable.unit}") if variable.unit else "NO_COMPU_METHOD"


def _conversions(variables: Iterable[Variable]) -> Iterator[str]:
    for variable in {_conversion(variable): variable for variable in variables}.values():
        declaration = variable.declaration
        if isinstance(declaration, Enumeration):
            rows = [f'      {k} "{name}"' for k, (name, _) in enumerate(declaration.items, 1)]
            about = {"meaning": _quoted(declaration.description), "count": len(rows), "rows": "\n".join(rows)}
            yield WORDS.format(name=declaration.name, **about)
        elif variable.unit:
            yield UNIT.format(name=_conversion(variable), unit=variable.unit)


def _group(name: str, meaning: str, kind: str, members: Iterable[Variable]) -> str:
    return GROUP.format(name=name, meaning=meaning, kind=kind, members=" ".join(v.name for v in members))


def _quoted(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"')

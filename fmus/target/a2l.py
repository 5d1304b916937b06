"""An ASAM A2L description of a controller on the target: what can be calibrated and measured, and at which address.

Names, units, limits and meanings are those of the declaration that all else comes from; addresses are those of the
linked image. All numbers there are of single precision, one after the other in the order of their records.
"""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from ...models.block.declaration import Enumeration
from ..child_process import output_of
from ..description.variables import Variable, interface
from ..fmu import Fmu

RECORDS = {"parameter": "calibration", "input": "u", "output": "y"}
"""By causality the record of link.c that holds such variables."""

CALIBRATION = {
    "tunable": ("Calibration", "what can be turned while the controller runs"),
    "fixed": ("Fixed", "what is set before the start: the car, what counters stop at"),
}
"""Groups of parameters by their variability."""

LARGEST = (2.0 - 2.0**-23) * 2.0**127
"""Of single precision."""

FILE = """\
ASAP2_VERSION 1 71

/begin PROJECT {name} "{description}"
  /begin MODULE {name} "{description}"

    /begin MOD_COMMON ""
      BYTE_ORDER MSB_LAST
      ALIGNMENT_FLOAT32_IEEE 4
    /end MOD_COMMON

    /begin RECORD_LAYOUT real
      FNC_VALUES 1 FLOAT32_IEEE ROW_DIR DIRECT
    /end RECORD_LAYOUT

{blocks}

  /end MODULE
/end PROJECT
"""

CHARACTERISTIC = """\
    /begin CHARACTERISTIC {name} "{meaning}"
      VALUE 0x{address:08X} real 0 {conversion} {low!r} {high!r}
    /end CHARACTERISTIC"""

MEASUREMENT = """\
    /begin MEASUREMENT {name} "{meaning}"
      FLOAT32_IEEE {conversion} 0 0 {low!r} {high!r}
      ECU_ADDRESS 0x{address:08X}
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


def description(fmu: Fmu, image: Path) -> str:
    """The A2L file for the controller in a linked image of `fmus.target.image`.

    Args:
        fmu: of that controller.
    """
    variables, addresses = interface(fmu.block), symbols(image)
    of = {causality: [v for v in variables if v.causality == causality] for causality in RECORDS}
    blocks = list(_conversions(variables))
    for causality, members in of.items():
        text = CHARACTERISTIC if causality == "parameter" else MEASUREMENT
        first = addresses[RECORDS[causality]]
        blocks += [_described(variable, first + 4 * k, text) for k, variable in enumerate(members)]
    for variability, (name, meaning) in CALIBRATION.items():
        members = [v for v in of["parameter"] if v.variability == variability]
        blocks += [_group(name, meaning, "REF_CHARACTERISTIC", members)] if members else []
    for causality in ("input", "output"):
        name = f"{causality.capitalize()}s"
        blocks.append(_group(name, f"{causality}s of the controller", "REF_MEASUREMENT", of[causality]))
    return FILE.format(name=fmu.name, description=fmu.block.description, blocks="\n\n".join(blocks))


def symbols(image: Path) -> Mapping[str, int]:
    """The addresses of what an image holds by name."""
    listing = output_of("arm-none-eabi-nm", image)
    rows = [line.split() for line in listing.splitlines()]
    return {row[2]: int(row[0], 16) for row in rows if len(row) == 3}


def _described(variable: Variable, address: int, text: str) -> str:
    low, high = (min(max(float(bound), -LARGEST), LARGEST) for bound in variable.bounds())
    meaning, conversion = _quoted(variable.declaration.description), _conversion(variable)
    return text.format(name=variable.name, meaning=meaning, address=address, conversion=conversion, low=low, high=high)


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

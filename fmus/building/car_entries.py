"""A car entry by entry: what a vehicle file sets, what follows from it, and what stays as in the default car."""

from collections.abc import Iterable, Iterator, Mapping
from textwrap import wrap
from typing import Any, NamedTuple

from fmublocks.description.variables import Variable

from ..catalogue import FMUS
from .estimates import HEAVIEST, LAWS, law
from .one_car import DAMPERS, FOLLOW, INSTEAD, MEASURED, SHAFTS, WHEELS, WITH_MASS, of_one_car, told_by_others
from .parameter_files import car_names, declarations, of_vehicle

SET, FOLLOWS, ESTIMATED, DEFAULT = "set", "follows", "estimated", "default"
"""Where the value of an entry is from."""

SECTIONS = {
    "The drive train, referred to the motor": ("J_1", "J_2", "C", "phi_B", "i"),
    "The vehicle": ("m", "r", "c_slip", "c_wa"),
    "Motor and bus": ("tau", "T_max", "T_cyc", "d_min", "d_max"),
}
"""What a short vehicle file has."""

WIDEST = 118
"""Characters of a line of comment in a vehicle file."""

TEMPLATE = """\
A car: an entry is one for all blocks that have it, in the units that are given. What stands behind a # is not set.
`driveline car FILE.toml --all` says what is set, what follows from it or is estimated, and what stays.
A text has its unit: "1887 kg". What is measured of a whole car at 15 km/h without control may stand in the place of C,
of d_s, d_g and d_p, and of phi_B:
frequency = "8 Hz"    # of its drive train
damping_ratio = 0.05  # of that
gap = "2 deg"         # at the wheel, from flank to flank"""

SOURCES = {
    "C": ", ".join(SHAFTS),
    **dict.fromkeys(SHAFTS, "C"),
    **dict.fromkeys(WHEELS, "J_2, i"),
    **dict.fromkeys(WITH_MASS, "m"),
    **{name: ", ".join(of) for name, of in DAMPERS.items()},
}
"""What an entry that follows mainly follows from."""


class Entry(NamedTuple):
    """An entry of a vehicle file.

    Attributes:
        unit: "" for none.
        origin: SET, FOLLOWS, ESTIMATED or DEFAULT.
        source: what it follows from or is estimated from, if it is.
        blocks: the FMUs that take it.
    """

    name: str
    value: Any
    unit: str
    meaning: str
    origin: str
    source: str
    blocks: tuple[str, ...]


def car(entries: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """All entries of a car by name, in SI units: those that are given, those that follow, those of the default car.

        driveline.car({"C": 150.0, "m": 1900.0})["k_s"]  # N.m/rad, of half shafts that make this C

    Args:
        entries: of a vehicle file, as `read_vehicle` gives them.

    Raises:
        ParameterFileError: one is not known, no number or out of range; they disagree, or there is no such car.
    """
    return {entry.name: entry.value for entry in car_entries(entries) if entry.name not in MEASURED}


def car_entries(entries: Mapping[str, Any] | None) -> list[Entry]:
    """The entries of a car: first those that are set, then those that follow or are estimated, then the others.

    Raises:
        ParameterFileError: see `car`.
    """
    entries = of_vehicle(entries)
    full = of_one_car(entries, FOLLOW)
    order = (SET, FOLLOWS, ESTIMATED, DEFAULT)
    declared = {**{name: (variable, ()) for name, variable in MEASURED.items() if name in entries}, **_declared()}
    rows = [_entry(name, variable, blocks, entries, full) for name, (variable, blocks) in declared.items()]
    return sorted(rows, key=lambda entry: order.index(entry.origin))


def template() -> str:
    """A vehicle file with the default car: what a short one has, and behind # what else can be set."""
    lines = [f"# {line}" for line in TEMPLATE.splitlines()]
    declared = _declared()
    shown = [name for names in SECTIONS.values() for name in names]
    sections = {
        **SECTIONS,
        "In the validation vehicle alone; follows from the above where it is not set": FOLLOW,
        "Beside": tuple(name for name in declared if name not in shown and name not in FOLLOW),
    }
    for title, names in sections.items():
        lines += ["", f"# {title}", *_template_lines(names, declared, title in SECTIONS)]
    return "\n".join(lines) + "\n"


def vehicle_text(comment: Iterable[str], entries: Mapping[str, Any]) -> str:
    """The text of a vehicle file with these entries, below lines of a comment, which are wrapped."""
    lines = [part for line in comment for part in wrap(line, WIDEST) or [""]]
    head = "\n".join(f"# {line}".rstrip() for line in lines)
    return f"{head}\n\n" + "".join(f"{name} = {_toml(value)}\n" for name, value in entries.items())


def _template_lines(names: tuple[str, ...], declared: "Declared", is_set: bool) -> Iterator[str]:
    texts = [f"{'' if is_set else '# '}{name} = {_toml(declared[name][0].start)}" for name in names]
    width = max(map(len, texts))
    for name, text in zip(names, texts, strict=True):
        variable, _ = declared[name]
        yield f"{text:{width}}  # {_meaning(variable)}; {variable.allowed()}"


def _meaning(variable: Variable) -> str:
    return str(variable.declaration.description)


def _toml(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else repr(value)


Declared = dict[str, tuple[Variable, tuple[str, ...]]]
"""Of each entry how it is declared, and which FMUs take it."""


def _declared() -> Declared:
    """The entries of a car: the parameters of plants, motor and bus."""
    owners = declarations(FMUS.values())
    return {name: (owners[name][0][1], tuple(fmu for fmu, _ in owners[name])) for name in car_names()}


def _entry(
    name: str, variable: Variable, blocks: tuple[str, ...], entries: Mapping[str, Any], full: Mapping[str, Any]
) -> Entry:
    origin, source = DEFAULT, ""
    if name in entries:
        origin, full = SET, entries
    elif name in full and name in LAWS and name not in told_by_others(entries):
        origin, source = ESTIMATED, ", ".join(law(name, entries))
    elif name == "F_z0" and full.get(name) == HEAVIEST:
        origin, source = ESTIMATED, "m"
    elif name in full:
        measured = next((by for by, of in INSTEAD.items() if by in entries and name in of), "")
        origin, source = FOLLOWS, measured or ("k_s" if name in SHAFTS and "k_s" in entries else SOURCES[name])
    return Entry(name, full.get(name, variable.start), variable.unit, _meaning(variable), origin, source, blocks)

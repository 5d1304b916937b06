"""Parameters in files: what belongs to a car in one, what is set in its controller in the other.

Both are flat TOML, `J_1 = 0.09`, with the names and units that the blocks declare; a text has a unit of its own,
`m = "1887 kg"`. An entry of a vehicle file is one for every block that declares the name: plant, motor, bus and the
controller's model of them. What no file names follows (one_car) or keeps its start value.
"""

import numbers
import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from fmublocks.block.declaration import Integer, Real
from fmublocks.description.variables import LARGEST, Variable, interface
from fmublocks.fmu import Fmu
from toolground.known_names import meant
from toolground.toml_file import toml_entries
from toolground.unit_conversion import quantity
from toolground.written_numbers import real

from ..catalogue import EVERY, FMUS
from ..errors import NoSuchCar, ParameterFileError
from ..names import RENAMED
from .estimates import SHEET
from .one_car import MEASURED, of_one_car

OF_A_RUN = {
    "v_0": "the manoeuvre sets it",
    "T_0": "the manoeuvre sets it",
    "seed": "--seed sets it for a run",
    "recorded_load": "--set plant.recorded_load=true sets it for a run",
}
"""Parameters that stand in no file, and what sets them."""

OF_CAR = "it is one of the car, for the file of --vehicle"
OF_CONTROLLER = "it is one of the controller, for the file of --parameters"

KINDS: Mapping[str, tuple[Any, str]] = {
    "Real": (numbers.Real, "a finite number"),
    "Integer": (numbers.Integral, "a whole number"),
    "Boolean": (bool, "true or false"),
}
"""By FMI type the Python type of an entry, and what it is called."""

MOST_PROBLEMS = 20
"""Lines of a refusal. A name that is not known is compared with all that are, which takes its time."""

LONGEST_NAME = 60
"""Characters of a name that is not known, as a message shows it."""

Owners = Mapping[str, Collection[tuple[str, Variable]]]
"""For each parameter the FMUs that have it, and how each declares it."""


def read_files(
    vehicle: Path | None, parameters: Path | None, own: Iterable[Fmu] = (), others: Collection[str] = ()
) -> dict[str, Any]:
    """The entries of both files, of which either may be absent; see `read_vehicle` and `read_parameters`."""
    of_car = read_vehicle(vehicle, own, others) if vehicle else {}
    return of_car | (read_parameters(parameters) if parameters else {})


def read_vehicle(path: Path, own: Iterable[Fmu] = (), others: Collection[str] = ()) -> dict[str, Any]:
    """The entries of a vehicle file by name, without those that follow from them (`of_one_car`).

    Args:
        own: FMUs with blocks of the user's own, whose parameters may stand in it too.
        others: names of parameters that may stand in it too, of FMUs that someone else has made.

    Raises:
        ParameterFileError: names the lines with what is not known, no number or out of range; or the entries that
            disagree.
    """
    known, set_elsewhere = _of_vehicle(own)
    values = _read(path, known, others, set_elsewhere)
    try:
        of_one_car(values, ())
    except NoSuchCar as problem:
        raise in_file(problem, path) from problem
    return values


def in_file(problem: NoSuchCar, path: Path) -> ParameterFileError:
    """The refusal of a car with the vehicle file that its entries stand in, and the first of their lines."""
    line = next((line for name in problem.entries if (line := _line(path, name))), None)
    return ParameterFileError(f"{path}{f', line {line}' if line else ''}: {problem}")


def of_vehicle(entries: Mapping[str, Any] | None) -> dict[str, Any]:
    """Entries that a program gives as those of a vehicle file, each as it would stand there; None: none.

    Raises:
        ParameterFileError: they are no mapping; or names those that are not known, no number or out of range.
    """
    if entries is None:
        return {}
    if not isinstance(entries, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]  # of a program without types
        raise ParameterFileError(
            f"the car {entries!r:.60} must be the entries of a vehicle file, as {{'m': 1900.0}}, or what read_vehicle "
            "gives"
        )
    known, set_elsewhere = _of_vehicle()
    return _values({str(name): entry for name, entry in entries.items()}, known, (), set_elsewhere)


def _of_vehicle(own: Iterable[Fmu] = ()) -> tuple[Owners, Mapping[str, str]]:
    """The entries of a vehicle file, and the names that do not belong there, with the reason."""
    everything, of_car = declarations([*EVERY.values(), *own]), car_names(own)
    of_controller = dict.fromkeys(everything.keys() - of_car, OF_CONTROLLER)
    measured = {name: [("a vehicle file", variable)] for name, variable in MEASURED.items()}
    return measured | {name: everything[name] for name in of_car}, of_controller | OF_A_RUN


def read_parameters(path: Path) -> dict[str, Any]:
    """The entries of a file with parameters of the controller, as `driveline design` writes it, by name.

    Raises:
        ParameterFileError: as for `read_vehicle`.
    """
    everything, of_car = declarations(EVERY.values()), dict.fromkeys(car_names(), OF_CAR)
    of_controller = {name: everything[name] for name in everything if name not in of_car}
    return _read(path, of_controller, (), of_car | OF_A_RUN)


def require_taken(parameters: Path | None, taken: Collection[str], by: str) -> None:
    """Refuses a file with parameters of a controller that is not there, which would change nothing.

    Args:
        taken: the names of the parameters of all that the file is for.
        by: what that is.

    Raises:
        ParameterFileError: names the entries that nothing takes.
    """
    if parameters and (lacking := [name for name in read_parameters(parameters) if name not in taken]):
        raise ParameterFileError(f"{parameters}: {by} has no parameter {', '.join(lacking)}")


def for_instances(values: Mapping[str, Any], instances: Mapping[str, Collection[str]]) -> dict[str, Any]:
    """Entries of a file as parameters of a loop, `instance.name` -> value, for every instance that has the name, with
    those that follow from them.

    Args:
        instances: the names of the parameters of each instance.

    Raises:
        ParameterFileError: see `of_one_car`.
    """
    values = of_one_car(values, set().union(*instances.values()))
    return {
        f"{instance}.{name}": values[name] for instance, names in instances.items() for name in values if name in names
    }


def units() -> dict[str, str]:
    """The unit of every entry that our own blocks have and that is a Real; "1" for none."""
    declared = {name: owners[0][1].declaration for name, owners in declarations(EVERY.values()).items()}
    return {name: declaration.unit for name, declaration in declared.items() if isinstance(declaration, Real)}


def seeds() -> tuple[int, int]:
    """The least and the largest seed that all blocks with noise take."""
    declared = [variable.declaration for _, variable in declarations(EVERY.values())["seed"]]
    bounds = [(of.minimum, of.maximum) for of in declared if isinstance(of, Integer)]
    return max(least for least, _ in bounds), min(most for _, most in bounds)


def of_plants() -> set[str]:
    """Names of the parameters of a car that the design model has."""
    return {quantity for quantity in FMUS["TwoMassDriveline"].block.Parameters._fields if quantity not in OF_A_RUN}


def car_names(own: Iterable[Fmu] = ()) -> list[str]:
    """Names of the parameters of everything but the controllers, which are what takes the driver's demand."""
    fmus = [fmu for fmu in FMUS.values() if "T_driver" not in fmu.block.Input._fields]
    return [name for name in declarations([*fmus, *own]) if name not in OF_A_RUN]


def declarations(fmus: Iterable[Fmu]) -> dict[str, list[tuple[str, Variable]]]:
    """For each parameter the names of the FMUs that have it, and how each declares it."""
    owners: dict[str, list[tuple[str, Variable]]] = {}
    for fmu in fmus:
        for variable in interface(fmu.block):
            if variable.causality == "parameter":
                owners.setdefault(variable.name, []).append((fmu.name, variable))
    return owners


def _read(path: Path, known: Owners, others: Collection[str], set_elsewhere: Mapping[str, str]) -> dict[str, Any]:
    try:
        entries = toml_entries(Path(path))
    except ValueError as reason:
        raise ParameterFileError(f"{path}: {reason}") from reason
    return _values(entries, known, others, set_elsewhere, lambda name: f"{path}, line {_line(path, name) or 1}: ")


def _values(
    entries: Mapping[str, Any],
    known: Owners,
    others: Collection[str],
    set_elsewhere: Mapping[str, str],
    where: Callable[[str], str] = lambda name: "",
) -> dict[str, Any]:
    """The values of entries; `where` an entry stands is said before what is wrong with it."""
    values: dict[str, Any] = {}
    problems: list[str] = []
    for name, entry in entries.items():
        try:
            values[name] = _checked(name, entry, known, others, set_elsewhere)
        except ParameterFileError as problem:
            problems.append(f"{where(name)}{problem}")
            if len(problems) == MOST_PROBLEMS:
                problems.append("there may be more")
                break
    usual = EVERY["WheelSpeedCan"].block.Parameters._field_defaults
    shortest, longest = (values.get(name, usual[name]) for name in ("d_min", "d_max"))
    if shortest > longest:
        place = where("d_min" if "d_min" in values else "d_max")
        problems.append(f"{place}d_min = {shortest:g} s is longer than d_max = {longest:g} s")
    if problems:
        raise ParameterFileError("\n".join(problems))
    return values


def _checked(name: str, entry: Any, known: Owners, others: Collection[str], set_elsewhere: Mapping[str, str]) -> Any:
    """The value of an entry; arguments as of `_read`.

    Raises:
        ParameterFileError: the entry is not known or has no such value.
    """
    shown = name if name.isprintable() and len(name) <= LONGEST_NAME else f"{name!r:.{LONGEST_NAME}}"
    if isinstance(entry, dict):
        raise ParameterFileError(f"{shown} is a table; an entry stands alone, for all that have it: J_1 = 0.09")
    if name in set_elsewhere:
        raise ParameterFileError(f"{name} does not belong here: {set_elsewhere[name]}")
    if name not in known and name not in others:
        raise ParameterFileError(f"{shown} is not known{_nearest(name, known, others)}")
    return _value(name, entry, known.get(name, ()))


def _value(name: str, entry: Any, owners: Collection[tuple[str, Variable]]) -> Any:
    """The value of an entry in SI units, which all that have the parameter must allow."""
    kind, written = next((variable.fmi_type for _, variable in owners), "Real"), entry
    if isinstance(entry, str) and kind == "Real":
        entry = _quantity(name, entry, next((variable.unit or "1" for _, variable in owners), ""))
    python_type, meant = KINDS[kind]
    if (
        not isinstance(entry, python_type)
        or isinstance(entry, bool) != (kind == "Boolean")
        or not abs(entry if isinstance(entry, int) else float(entry)) <= LARGEST
    ):
        raise ParameterFileError(f"{name} = {entry!r:.40}: it must be {meant}")
    for fmu, variable in owners:
        low, high = variable.bounds()
        if not low <= entry <= high:
            degrees = f'; "{written} deg" is in degrees' if variable.unit == "rad" and written == entry else ""
            raise ParameterFileError(f"{name} = {entry:g}: {fmu} takes {variable.allowed()}{degrees}")
    return float(entry) if kind == "Real" else entry


def _quantity(name: str, text: str, unit: str) -> float:
    try:
        if unit and real(text) is not None:
            raise ParameterFileError(f'{name} = "{text:.40}": a number in {unit} stands without quotes')
        if unit:
            return quantity(text, unit)
        reason = "must be a finite number"
    except ValueError as problem:
        reason = f"{problem}; a number alone is in {unit}"
    raise ParameterFileError(f"{name} = {text!r:.40}: it {reason}")


SYNONYMS = {
    **dict.fromkeys(("tyre", "tire"), "wheel"),
    **dict.fromkeys(("max", "maximum", "peak", "rated"), "largest"),
    **dict.fromkeys(("weight", "curb", "kerb", "vehicle"), "mass"),
    **dict.fromkeys(("reduction", "final_drive", "i_total"), "ratio"),
    **dict.fromkeys(("cd", "c_d", "cw", "c_w", "cx", "drag_coefficient"), "air_drag"),
    "rotor": "motor_inertia",
    "lash": "backlash",
    "cog": "gravity",
}
"""Words of data sheets, and names that these have, as the descriptions say them."""


def _nearest(name: str, known: Owners, others: Collection[str]) -> str:
    """What a name may have been meant to be: what its words describe, of a data sheet first, else what is like it."""
    words = name.lower().split("_")
    meant_words = SYNONYMS.get(name.lower(), "_".join(SYNONYMS.get(word, word) for word in words)).split("_")
    places = _described(meant_words, known) or _described(words, known)
    first = [candidate for candidate, at in places.items() if at == min(places.values()) and name not in RENAMED]
    near = f"did you mean {' or '.join(first[:3])}?" if first else meant(name, sorted({*known, *others}))
    return f"; {near}" if near else ""


def _described(words: Sequence[str], known: Owners) -> dict[str, int]:
    """Names whose descriptions have words that begin with all of these, of a data sheet if there are any, and where."""
    places: dict[str, int] = {}
    for candidate, ((_, variable), *_) in known.items():
        described = variable.declaration.description.replace(",", "").split()
        places_of = [[k for k, of in enumerate(described) if of.startswith(word)] for word in words if len(word) > 2]
        if all(places_of) and len(places_of) == len(words):
            places[candidate] = min(map(min, places_of))
    return {candidate: at for candidate, at in places.items() if candidate in SHEET} or places


def _line(path: Path, name: str) -> int | None:
    """Number of the line of a file where the entry or table of that name begins."""
    begins = re.compile(rf"""\s*\[*\s*["']?{re.escape(name)}["']?\s*[=.\]]""")
    lines = path.read_text(encoding="utf-8-sig").splitlines()
    return next((k for k, line in enumerate(lines, 1) if begins.match(line)), None)

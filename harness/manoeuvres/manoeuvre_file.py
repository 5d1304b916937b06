"""Manoeuvres that are written in files: TOML with the parts of each signal, or a table of the signals over time.

    duration = 6.0          # s
    v_0 = "15 km/h"         # a number is in SI units, a text has its unit
    T_driver = [
        { kind = "constant", value = -12.0 },
        { kind = "step", at = 1.0, height = 112.0 },
    ]

Every kind and its keys are a function of `harness.manoeuvres.parts` and its arguments.
"""

from collections.abc import Iterator, Mapping
from inspect import Parameter, signature
from math import atan, isfinite
from pathlib import Path
from typing import Any

from toolground.known_names import nearest
from toolground.plain_text import plain
from toolground.toml_file import toml_entries

from ..loop.places import STEP_SIZE
from .composed import composed
from .manoeuvre import Manoeuvre
from .parts import KINDS, LONGEST, UNITS, ManoeuvreError, constant, summed
from .signals import NOTHING, Lines, Signal

SIGNALS = {"T_driver": "N.m", "T_brake": "N.m", "slope": "rad"}
"""What a manoeuvre is made of, and the units."""

KEYS = ("description", "duration", "v_0", *SIGNALS)

EXAMPLES = {"s": "200 ms", "Hz": "5 Hz", "N.m": "0.1 kN.m", "rad": "5 %", "m/s": "15 km/h"}
"""Of a text with a unit, by the unit of the SI."""


def read_manoeuvre(path: Path) -> Manoeuvre:
    """The manoeuvre of a file, with the name of the file.

    TOML is what ends with .toml; all else is a table of the signals over time and read as a recording is.

    Raises:
        ManoeuvreError: names file, key and value, and what is allowed.
        RecordingError: of a table; names the file, the column and what is wrong.
    """
    path = Path(path)
    return _from_toml(path) if path.suffix == ".toml" else _from_table(path)


def _from_toml(path: Path) -> Manoeuvre:
    try:
        entries = _entries(path)
        for name in entries:
            if name not in KEYS:
                raise ManoeuvreError(f"{plain(name, 60)} is no key; {nearest(name, KEYS)}")
        if "duration" not in entries:
            raise ManoeuvreError("no duration; it needs one, in s")
        duration = _number("duration", entries["duration"], "s")
        if not STEP_SIZE <= duration <= LONGEST:
            raise ManoeuvreError(f"duration = {duration:g}: it must be {STEP_SIZE:g} to {LONGEST:g} s")
        description = entries.get("description", f"the manoeuvre of {path.name}")
        if not isinstance(description, str):
            raise ManoeuvreError(f"description = {plain(description, 60)}: it must be a text")
        return composed(
            path.stem,
            duration,
            _number("v_0", entries.get("v_0", 0.0), "m/s"),
            *(_signal(name, entries.get(name, 0.0), unit, duration) for name, unit in SIGNALS.items()),
            description=plain(description),
        )
    except ManoeuvreError as problem:
        raise ManoeuvreError(f"{path}: {problem}") from problem


def _entries(path: Path) -> dict[str, Any]:
    try:
        entries = toml_entries(path)
    except ValueError as reason:
        raise ManoeuvreError(str(reason)) from reason
    if not entries:
        raise ManoeuvreError(f"it is empty; a manoeuvre has {', '.join(KEYS)}")
    return entries


def _signal(name: str, entry: Any, unit: str, duration: float) -> Signal:
    """
    Args:
        entry: one number, or the list of its parts.
        unit: of its values.
        duration: of the manoeuvre in s.
    """
    if not isinstance(entry, list):
        return constant(_number(name, entry, unit))
    return summed(_parts(name, entry, unit, duration))


def _parts(name: str, entries: list[Any], unit: str, duration: float) -> Iterator[Signal]:
    for number, entry in enumerate(entries, 1):
        where = f"{name}, part {number}"
        if not isinstance(entry, dict):
            raise ManoeuvreError(
                f'{where} is {plain(entry, 60)}; it must be such as {{ kind = "constant", value = 1 }}'
            )
        kind = entry.get("kind")
        if not isinstance(kind, str) or kind not in KINDS:
            shown = "it has no kind" if kind is None else f"kind = {plain(repr(kind), 60)} is unknown"
            raise ManoeuvreError(f"{where}: {shown}; {nearest(str(kind or ''), KINDS)}")
        try:
            arguments = _arguments(kind, {key: value for key, value in entry.items() if key != "kind"}, unit)
            for key in ("at", "begin"):
                if key in arguments and not arguments[key] < duration:
                    raise ManoeuvreError(f"{key} = {arguments[key]:g}: the manoeuvre ends at {duration:g} s")
            yield KINDS[kind](**arguments)
        except ManoeuvreError as problem:
            raise ManoeuvreError(f"{where}, {kind}: {problem}") from problem


def _arguments(kind: str, entry: Mapping[str, Any], unit: str) -> dict[str, Any]:
    """The arguments of a part, in SI units."""
    arguments = signature(KINDS[kind]).parameters
    for key in entry:
        if key not in arguments:
            raise ManoeuvreError(f"{plain(key, 60)} is no key; {nearest(key, arguments)}")
    for key, argument in arguments.items():
        if argument.default is Parameter.empty and key not in entry:
            raise ManoeuvreError(f"no {key}; it needs {', '.join(arguments)}")
    return {key: _argument(key, value, UNITS.get(key, unit)) for key, value in entry.items()}


def _argument(key: str, value: Any, unit: str) -> Any:
    match key, value:
        case "points", list():
            return [_point(k, point, unit) for k, point in enumerate(value, 1)]
        case "points", _:
            raise ManoeuvreError(f"points = {plain(value, 60)}: it must be a list such as [[0, 10], [1, 50]]")
        case "order", int() if not isinstance(value, bool):
            return value
        case "order", _:
            raise ManoeuvreError(f"order = {plain(repr(value), 60)}: it must be a whole number")
    return _number(key, value, unit)


def _point(k: int, point: Any, unit: str) -> tuple[float, float]:
    if not (isinstance(point, list) and len(point) == 2):
        raise ManoeuvreError(f"point {k} is {plain(point, 60)}; it must be an instant and a value, as in [1, 50]")
    return _number(f"the instant of point {k}", point[0], "s"), _number(f"the value of point {k}", point[1], unit)


def _number(key: str, value: Any, unit: str) -> float:
    """A finite number in SI units, of a number or a text with a unit."""
    if isinstance(value, str):
        return _converted(key, value, unit)
    if isinstance(value, dict):
        raise ManoeuvreError(f"{key} is one part: parts stand in a list, {key} = [{{...}}]")
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise ManoeuvreError(
            f"{key} = {plain(repr(value), 60)}: it must be a finite number of {unit}, or a text such as "
            f'"{EXAMPLES[unit]}"'
        )
    return float(value)


def _converted(key: str, text: str, unit: str) -> float:
    from toolground.unit_conversion import quantity

    try:
        if unit == "rad" and text.endswith(" %"):
            return atan(0.01 * quantity(text, "%"))
        return quantity(text, unit)
    except ValueError as reason:
        raise ManoeuvreError(f'{key} = "{plain(text, 60)}" {reason}; "{EXAMPLES[unit]}" is one') from reason


def _from_table(path: Path) -> Manoeuvre:
    """Of straight lines between the rows, two at one instant being a jump; it begins with the first row."""
    from driverecords.driver_and_road import read_course

    course = read_course(path)
    try:
        duration = float(course.time[-1])
        if not STEP_SIZE <= duration <= LONGEST:
            raise ManoeuvreError(f"it lasts {duration:g} s; it must be {STEP_SIZE:g} to {LONGEST:g} s")
        drawn = {name: Lines(course.time.tolist(), values.tolist()) for name, values in course.signals.items()}
        signals = (drawn.get(name, NOTHING) for name in SIGNALS)
        return composed(path.stem, duration, course.v_0, *signals, description=f"the manoeuvre of {path.name}")
    except ManoeuvreError as problem:
        raise ManoeuvreError(f"{path}: {problem}") from problem

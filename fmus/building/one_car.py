"""One car for both plants and for the design, from the entries of a vehicle file.

The design model has a car as two masses, the validation vehicle the same car in detail. Its C has tyres and mounts in
it, so k_s is no part of C alone. What a file does not name follows from what it names, as in the default car:

    k_s, k_g, k_p   from C: both plants, rolling at 15 km/h, swing at frequencies as far apart as those of the default
                    car, in which the tyres explain the difference; the three keep their shares
    C               from them, where the file has one of them and no C
    J_w, J_g        from J_2 i^2, in proportion
    F_z0, J_y, ...  from m, in proportion: pitch and hubs keep their frequencies
    d_s, d_g, d_p   damping ratios stay

An entry of its own stands. Where two entries say different things of the same, the file is refused.
"""

from collections.abc import Callable, Collection, Mapping
from functools import cache
from math import exp, log, sqrt
from typing import Any

from ...models import two_mass_driveline, validation_vehicle
from ...models.block.types import ContinuousBlock
from ..description.variables import interface
from ..errors import ParameterFileError

SHAFTS = ("k_s", "k_g", "k_p")
"""What is elastic between motor and wheels in the validation vehicle: half shafts, gear stage, mounts."""

WHEELS = ("J_w", "J_g")
"""What turns with the wheels there."""

WITH_MASS = ("F_z0", "J_y", "k_th", "d_th", "m_h", "k_x", "d_x", "J_p")
"""What a heavier car has more of there."""

DAMPERS = {"d_s": ("k_s", "J_w"), "d_g": ("k_g", "J_g"), "d_p": ("k_p", "J_p")}
"""Each with its spring and its inertia."""

FOLLOW = (*SHAFTS, *WHEELS, *WITH_MASS, *DAMPERS)
"""What the validation vehicle alone has and what follows."""

APART = 0.03
"""Relative difference from which on two frequencies, inertias or loads disagree."""

DIGITS = 6
"""Significant digits of what follows."""

FURTHEST = 100.0
"""Factor on what is elastic in the default car, within which it is looked for."""

SECANTS, NEAR = 8, 1e-6
"""Steps in which it is found, and the last of them; what is missed after one is far less."""

DESIGN, DETAILED = two_mass_driveline.BLOCK, validation_vehicle.BLOCK

DECLARED = {
    variable.name: (block.name, variable)
    for block in (DESIGN, DETAILED)
    for variable in interface(block)
    if variable.causality == "parameter"
}
"""The parameters of a car in both plants: who has it, and how it is declared."""

DEFAULT_CAR: Mapping[str, float] = {name: variable.start for name, (_, variable) in DECLARED.items()}
"""The default car."""


def of_one_car(entries: Mapping[str, Any], taken: Collection[str]) -> dict[str, Any]:
    """The entries with what follows from them; all else is as in the default car.

    Args:
        entries: of a vehicle file, and others beside, in SI units.
        taken: names of the parameters that are to be set. What the validation vehicle alone has follows if they are
            among them.

    Raises:
        ParameterFileError: entries disagree, are no numbers or out of bounds, or there is no such car.
    """
    given = frozenset((name, _number(name, value)) for name, value in entries.items() if name in DECLARED)
    followed = _common(given) | (_detailed(given) if set(taken) >= set(FOLLOW) else {})
    return {**entries, **followed}


def updated(entries: Mapping[str, Any], known: Mapping[str, Any]) -> dict[str, Any]:
    """The entries of a vehicle file with others that have become known; shafts follow from a C that has.

    Args:
        known: entries that replace or add to those.
    """
    stays = {name: value for name, value in entries.items() if "C" not in known or name not in SHAFTS}
    return {**stays, **known}


def differences(entries: Mapping[str, Any], others: Mapping[str, Any], taken: Collection[str]) -> dict[str, Any]:
    """What is to be set where entries are replaced by others, with what follows.

    Args:
        entries, others: as of `of_one_car`, and the errors too.
    """
    before, after = of_one_car(entries, taken), of_one_car(others, taken)
    changed = {name: value for name, value in after.items() if before.get(name) != value}
    return changed | {name: DEFAULT_CAR[name] for name in before.keys() - after.keys()}


@cache
def _common(given: frozenset[tuple[str, float]]) -> dict[str, float]:
    """What follows for both plants and the design: C, if the file has what is elastic in detail instead."""
    car = dict(given)
    for name, value in given:
        _require_possible(name, value)
    _require_agreeing(car)
    if not any(name in car for name in SHAFTS) or ("C" in car and "k_s" not in car):
        return {}
    wanted = _frequency(DETAILED, with_details(car, 1.0)) / frequencies_apart()
    C = _solved(lambda C: _frequency(DESIGN, car | {"C": C}), wanted, *DECLARED["C"][1].bounds(), "C")
    if "C" not in car:
        return _others_than_usual({"C": C})
    if not _close(_frequency(DESIGN, car), wanted):
        raise ParameterFileError(
            f"C = {car['C']:g} N.m/rad and {_told(car, *SHAFTS)} disagree: with that C would be {C:.4g} N.m/rad; "
            "leave one of them out, and it follows"
        )
    return {}


@cache
def _detailed(given: frozenset[tuple[str, float]]) -> dict[str, float]:
    """What follows for the validation vehicle."""
    car = dict(given)
    factor = 1.0
    if given and "k_s" not in car and ("C" in car or not any(name in car for name in SHAFTS)):
        wanted = _frequency(DESIGN, car) * frequencies_apart()
        what = f"{_told(car | {'C': car.get('C', DEFAULT_CAR['C'])}, 'C', 'c_slip', 'k_g', 'k_p')}: k_s"
        factor = _solved(
            lambda factor: _frequency(DETAILED, with_details(car, factor)), wanted, 1.0 / FURTHEST, FURTHEST, what
        )
    followed = _others_than_usual({name: with_details(car, factor)[name] for name in FOLLOW if name not in car})
    for name, value in followed.items():
        _require_possible(name, value, " as it follows from the other entries; give it")
    return followed


def with_details(car: Mapping[str, float], factor: float) -> dict[str, float]:
    """The car with what follows in the validation vehicle.

    Args:
        factor: on what is elastic in the default car, unless the car has half shafts of its own.
    """

    def over_usual(name: str) -> float:
        return found.get(name, DEFAULT_CAR[name]) / DEFAULT_CAR[name]

    found = dict(car)
    factor = over_usual("k_s") if "k_s" in car else factor
    ratio = over_usual("i")
    scaled = {
        **dict.fromkeys(SHAFTS, factor),
        **dict.fromkeys(WHEELS, over_usual("J_2") * ratio * ratio),
        **dict.fromkeys(WITH_MASS, over_usual("m")),
    }
    found |= {name: DEFAULT_CAR[name] * by for name, by in scaled.items() if name not in car}
    dampers = {name: sqrt(over_usual(k) * over_usual(J)) for name, (k, J) in DAMPERS.items()}
    return found | {name: DEFAULT_CAR[name] * by for name, by in dampers.items() if name not in car}


def _require_agreeing(car: Mapping[str, float]) -> None:
    """Refuses wheels that are heavier than J_2, and an axle that carries more than the car or less than its hubs."""
    full = {**DEFAULT_CAR, **with_details(car, 1.0)}
    wheels, of_J_2 = full["J_w"] + full["J_g"], full["J_2"] * full["i"] ** 2
    if wheels > (1.0 + APART) * of_J_2:
        raise ParameterFileError(
            f"J_w + J_g = {wheels:.4g} kg.m2 and J_2 = {full['J_2']:g} kg.m2 disagree: with i = {full['i']:g} J_2 is "
            f"{of_J_2:.4g} kg.m2 at the wheels, and has them in it"
        )
    for less, more, told in (
        (full["F_z0"], full["m"] * full["g"], f"F_z0 = {full['F_z0']:g} N and m = {full['m']:g} kg"),
        (full["m_h"] * full["g"], full["F_z0"], f"m_h = {full['m_h']:g} kg and F_z0 = {full['F_z0']:g} N"),
    ):
        if less > (1.0 + APART) * more:
            raise ParameterFileError(f"{told} disagree: {less:.4g} N are more than the {more:.4g} N that they are of")


def _frequency(plant: ContinuousBlock, car: Mapping[str, float]) -> float:
    """In Hz, at which the drive train of the car swings in a plant."""
    from .oscillation import oscillation  # numerics, which only a car that is not the default one needs

    fields = plant.Parameters._fields
    return oscillation(plant, plant.Parameters(**{name: car[name] for name in fields if name in car})).frequency


@cache
def frequencies_apart() -> float:
    """Frequency of the validation vehicle over that of the design model, in the default car."""
    return _frequency(DETAILED, {}) / _frequency(DESIGN, {})


def _solved(frequency: Callable[[float], float], wanted: float, low: float, high: float, what: str) -> float:
    """The value at which a frequency, which grows with it, is the one that is wanted.

    Raises:
        ParameterFileError: there is none between low and high; begins with what is looked for.
    """

    def missed(x: float) -> float:
        return log(frequency(exp(x)) / wanted)

    found = _by_secants(missed, log(low), log(high))
    if found is not None:
        return exp(found)
    least, most = frequency(low), frequency(high)
    if not least <= wanted <= most:
        raise ParameterFileError(
            f"{what} does not follow: the drive train would have to swing at {wanted:.3g} Hz, and can at "
            f"{least:.3g} to {most:.3g} Hz"
        )
    from scipy.optimize import brentq  # pyright: ignore[reportUnknownVariableType]

    found = brentq(missed, log(low), log(high), xtol=1e-9)  # pyright: ignore[reportUnknownVariableType]
    return exp(found)  # pyright: ignore[reportArgumentType, reportUnknownArgumentType]


def _by_secants(missed: Callable[[float], float], low: float, high: float) -> float | None:
    """Where what is missed is zero, from the middle in few steps; None: these lead out or do not end.

    A linearised plant is costly, and the logarithms of stiffness and frequency are nearly on a line.
    """
    before, was = (low + high) / 2.0, missed((low + high) / 2.0)
    x = before - 2.0 * was  # a frequency grows as the root of the stiffness
    for _ in range(SECANTS):
        if not low <= x <= high:
            return None
        now = missed(x)
        if now == was:
            return x if now == 0.0 else None
        before, was, x = x, now, x - now * (x - before) / (now - was)
        if abs(x - before) <= NEAR:
            return x
    return None


def _close(frequency: float, other: float) -> bool:
    return abs(log(frequency / other)) <= log(1.0 + APART)


def _others_than_usual(found: Mapping[str, float]) -> dict[str, float]:
    """What has followed, rounded, where it is not that of the default car."""
    rounded = {name: float(f"{value:.{DIGITS}g}") for name, value in found.items()}
    return {name: value for name, value in rounded.items() if value != DEFAULT_CAR[name]}


def _told(car: Mapping[str, float], *names: str) -> str:
    """Those of the names that the car has, with value and unit."""
    return ", ".join(f"{name} = {car[name]:g} {DECLARED[name][1].unit}" for name in names if name in car)


def _number(name: str, value: Any) -> float:
    """The value as the models take it; the numbers of NumPy answer comparisons with what is no bool.

    Raises:
        ParameterFileError: it is no number.
    """
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ParameterFileError(f"{name} = {value!r:.40}: it must be a number") from None


def _require_possible(name: str, value: float, why: str = "") -> None:
    block, variable = DECLARED[name]
    low, high = variable.bounds()
    if not low <= value <= high:
        raise ParameterFileError(f"{name} = {value:g}{why}: {block} takes {variable.allowed()}")

"""One car for both plants and for the design, from the entries of a vehicle file.

The design model has a car as two masses, the validation vehicle the same car in detail. Its C has tyres and mounts in
it, so k_s is no part of C alone. What a file does not name follows from what it names, as in the default car:

    k_s, k_g, k_p   from C: both plants, rolling at 15 km/h, swing at frequencies as far apart as those of the default
                    car, in which the tyres explain the difference; the three keep their shares
    C               from them, where the file has one of them and no C
    J_w, J_g        from J_2 i^2, in proportion
    F_z0, J_y, ...  from m, in proportion: pitch and hubs keep their frequencies
    d_s, d_g, d_p   damping ratios stay
    J_1, J_2, C, phi_B, c_slip   estimated from T_max, i, r, m (estimates), where none of the others tells them

What an engineer measures of the whole car may stand in the place of what a block takes (Measured): C follows from the
frequency, d_s, d_g, d_p from the damping ratio, phi_B from the gap. An entry of its own stands. Where two entries say
different things of the same, the file is refused.
"""

from collections.abc import Callable, Collection, Mapping
from functools import cache
from math import exp, log, sqrt
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from fmublocks.block.declaration import Real, variables
from fmublocks.block.types import ContinuousBlock
from fmublocks.description.variables import Variable, interface

from ...models import motor_torque_loop, two_mass_driveline, validation_vehicle
from ..errors import NoSuchCar, ParameterFileError
from .estimates import LAWS, SHEET, estimated, law

if TYPE_CHECKING:
    from .oscillation import Mode

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

LEAST_DAMPING = 1e-3
"""Factor on what damps in the default car, from which on a damping ratio is looked for; up to FURTHEST."""

DESIGN, DETAILED, MOTOR = two_mass_driveline.BLOCK, validation_vehicle.BLOCK, motor_torque_loop.BLOCK


class Measured(NamedTuple):
    """What is measured of a whole car, with its drive train in contact, rolling at 15 km/h without control."""

    frequency: Annotated[float, Real("Hz", "at which the drive train swings, in the place of C", 0.3, 30.0)]
    damping_ratio: Annotated[float, Real("1", "of that swing, in the place of d_s, d_g, d_p", 0.005, 0.5)]
    gap: Annotated[float, Real("rad", "at the wheel from flank to flank, in the place of phi_B", 0.0, 0.2)]


MEASURED = {q.name: Variable(-1, q.name, "parameter", q.declaration, None) for q in variables(Measured)}
"""How they are declared."""

DECLARED = {
    variable.name: (block.name, variable)
    for block in (DESIGN, DETAILED)
    for variable in interface(block)
    if variable.causality == "parameter"
}
"""The parameters of a car in both plants: who has it, and how it is declared."""

DEFAULT_CAR: Mapping[str, float] = {name: variable.start for name, (_, variable) in DECLARED.items()}
"""The default car."""

OF_CAR = {
    **DECLARED,
    **{name: ("a vehicle file", variable) for name, variable in MEASURED.items()},
    **{variable.name: (MOTOR.name, variable) for variable in interface(MOTOR) if variable.name == "T_max"},
}
"""All from which something follows."""

INSTEAD = {"frequency": ("C", *SHAFTS), "damping_ratio": tuple(DAMPERS), "gap": ("phi_B",)}
"""What follows from what is measured, and is not given beside it."""


DECIDING = (*INSTEAD, "C", *SHAFTS, "J_1", "J_2", "c_slip", *SHEET, "F_z0", *WHEELS, "J_p")
"""Entries that a message names where there is no such car: what decides how it swings."""


def told_by_others(entries: Collection[str]) -> set[str]:
    """Names of entries that others tell, so that nobody need give or estimate them."""
    told = {name for by, names in INSTEAD.items() if by in entries for name in names}
    return told | {"C" for name in SHAFTS if name in entries}


def of_one_car(entries: Mapping[str, Any], taken: Collection[str]) -> dict[str, Any]:
    """The entries with what follows from them; all else is as in the default car.

    Args:
        entries: of a vehicle file, and others beside, in SI units.
        taken: names of the parameters that are to be set. What the validation vehicle alone has follows if they are
            among them.

    Raises:
        ParameterFileError: entries are no numbers.
        NoSuchCar: they disagree, are out of bounds, or no car has them.
    """
    known = {name: _number(name, value) for name, value in entries.items() if name in OF_CAR}
    try:
        followed = _common(frozenset(known.items()))
        if set(taken) >= set(FOLLOW):
            followed = followed | _detailed(frozenset({**known, **followed}.items()))
    except _DoesNotFollow as problem:
        deciding = [name for name in DECIDING if name in known] or [*known]
        guessed = [name for name in LAWS if name not in {*known, *told_by_others(known)} and law(name, known)]
        also = f"; estimated: {', '.join(guessed)}" if guessed else ""
        raise NoSuchCar(f"{_told(known, *deciding)}: {problem}{also}", *deciding) from problem
    return {**{name: value for name, value in entries.items() if name not in MEASURED}, **followed}


def with_estimates(entries: Mapping[str, Any]) -> dict[str, Any]:
    """The entries of a vehicle file with all that is estimated or follows from what was measured: if one of them is
    turned then, the others stay."""
    elastic = any(name in entries for name in SHAFTS)
    usual = {name: DEFAULT_CAR[name] for name in LAWS}
    full = of_one_car(entries, FOLLOW) if "damping_ratio" in entries else of_one_car(entries, ())
    kept = {name: value for name, value in full.items() if name in {*entries, *usual, *DAMPERS, "F_z0"}}
    return {name: value for name, value in {**usual, **kept}.items() if name != "C" or "C" in entries or not elastic}


def updated(entries: Mapping[str, Any], known: Mapping[str, Any]) -> dict[str, Any]:
    """The entries of a vehicle file with others that have become known; shafts follow from a C that has.

    Args:
        known: entries that replace or add to those.
    """
    replaced = {name for name, of in INSTEAD.items() if {*of} & known.keys()} | {*(SHAFTS if "C" in known else ())}
    return {**{name: value for name, value in entries.items() if name not in replaced}, **known}


class _DoesNotFollow(Exception):
    """Something cannot follow from the entries of a car; the text says what."""


@cache
def _common(entries: frozenset[tuple[str, float]]) -> dict[str, float]:
    """What follows for both plants and the design: what no entry tells, as it is estimated; C, if the file has the
    frequency or what is elastic in detail instead; phi_B from the gap."""
    car = dict(entries)
    for name, value in entries:
        _require_possible(name, value)
    for name, of in INSTEAD.items():
        if name in car and (both := [other for other in of if other in car]):
            raise NoSuchCar(f"{_told(car, name, *both)}: leave one out, as {both[0]} follows from {name}", name)
    elastic, told = any(name in car for name in SHAFTS), told_by_others(car)
    derived = {name: value for name, value in estimated(car).items() if name not in told}
    bounds = {name: DECLARED[name][1].bounds() for name in derived}
    derived = {name: min(max(value, bounds[name][0]), bounds[name][1]) for name, value in derived.items()}
    if "gap" in car:
        derived["phi_B"] = 0.5 * car["gap"] * car.get("i", DEFAULT_CAR["i"])
    derived = _others_than_usual(derived)
    car |= derived
    _require_agreeing(car)

    def frequency_with(C: float) -> float:
        return _frequency(DESIGN, car | {"C": C}) * frequencies_apart()

    if "frequency" in car:
        wanted = car["frequency"]
    elif not elastic or ("C" in car and "k_s" not in car):
        return derived
    else:
        wanted = _frequency(DETAILED, with_details(car, 1.0))
    C = _solved(DESIGN, frequency_with, wanted, *DECLARED["C"][1].bounds())
    if "C" not in car:
        return derived | _others_than_usual({"C": C})
    if not _close(frequency_with(car["C"]), wanted):
        raise NoSuchCar(
            f"C = {car['C']:g} N.m/rad and {_told(car, *SHAFTS)} disagree: with that C would be {C:.4g} N.m/rad; "
            "leave one of them out, and it follows",
            "C",
        )
    return derived


@cache
def _detailed(entries: frozenset[tuple[str, float]]) -> dict[str, float]:
    """What follows for the validation vehicle."""
    car = {name: value for name, value in entries if name in DECLARED or name == "damping_ratio"}

    def stiffness(damping: float) -> float:
        if not car or "k_s" in car or ("C" not in car and any(name in car for name in SHAFTS)):
            return 1.0
        wanted = _frequency(DESIGN, car) * frequencies_apart()

        def frequency_with(factor: float) -> float:
            return _frequency(DETAILED, with_details(car, factor, damping))

        return _solved(DETAILED, frequency_with, wanted, 1.0 / FURTHEST, FURTHEST)

    def damping_ratio(damping: float) -> float:
        return _oscillation(DETAILED, with_details(car, factor, damping)).damping_ratio

    factor, damping = stiffness(1.0), 1.0
    if "damping_ratio" in car:
        damping = _solved(DETAILED, damping_ratio, car["damping_ratio"], LEAST_DAMPING, FURTHEST, "damping ratio", "")
        factor = stiffness(damping)
    followed = {name: with_details(car, factor, damping)[name] for name in FOLLOW if name not in car}
    followed = _others_than_usual(followed)
    for name, value in followed.items():
        if impossible := _impossible(name, value):
            raise _DoesNotFollow(f"{_told({name: value}, name)} would follow, and {impossible}")
    return followed


def with_details(car: Mapping[str, float], factor: float, damping: float = 1.0) -> dict[str, float]:
    """The car with what follows in the validation vehicle.

    Args:
        factor: on what is elastic in the default car, unless the car has half shafts of its own.
        damping: factor on dampers that keep the damping ratios of the default car.
    """

    def over_usual(name: str) -> float:
        return details.get(name, DEFAULT_CAR[name]) / DEFAULT_CAR[name]

    details = dict(car)
    factor = over_usual("k_s") if "k_s" in car else factor
    ratio = over_usual("i")
    scaled = {
        **dict.fromkeys(SHAFTS, factor),
        **dict.fromkeys(WHEELS, over_usual("J_2") * ratio * ratio),
        **dict.fromkeys(WITH_MASS, over_usual("m")),
    }
    details |= {name: DEFAULT_CAR[name] * by for name, by in scaled.items() if name not in car}
    dampers = {name: damping * sqrt(over_usual(k) * over_usual(J)) for name, (k, J) in DAMPERS.items()}
    return details | {name: DEFAULT_CAR[name] * by for name, by in dampers.items() if name not in car}


def _require_agreeing(car: Mapping[str, float]) -> None:
    """Refuses wheels that are heavier than J_2, and an axle that carries more than the car or less than its hubs."""
    full = {**DEFAULT_CAR, **with_details(car, 1.0)}
    wheels, of_J_2 = full["J_w"] + full["J_g"], full["J_2"] * full["i"] ** 2
    if wheels > (1.0 + APART) * of_J_2:
        raise NoSuchCar(
            f"J_w + J_g = {wheels:.4g} kg.m2 and J_2 = {full['J_2']:g} kg.m2 disagree: with i = {full['i']:g} J_2 is "
            f"{of_J_2:.4g} kg.m2 at the wheels, and has them in it",
            *WHEELS,
            "J_2",
        )
    for less, more, names in (
        (full["F_z0"], full["m"] * full["g"], ("F_z0", "m")),
        (full["m_h"] * full["g"], full["F_z0"], ("m_h", "F_z0")),
    ):
        if less > (1.0 + APART) * more:
            told = " and ".join(_told(full, name) for name in names)
            raise NoSuchCar(
                f"{told} disagree: {less:.4g} N are more than the {more:.4g} N that they are of", *names, "g"
            )


def _frequency(plant: ContinuousBlock, car: Mapping[str, float]) -> float:
    """In Hz, at which the drive train of the car swings in a plant."""
    return _oscillation(plant, car).frequency


def _oscillation(plant: ContinuousBlock, car: Mapping[str, float]) -> "Mode":
    from .oscillation import oscillation  # numerics, which only a car that is not the default one needs

    fields = plant.Parameters._fields
    return oscillation(plant, plant.Parameters(**{name: car[name] for name in fields if name in car}))


@cache
def frequencies_apart() -> float:
    """Frequency of the validation vehicle over that of the design model, in the default car."""
    return _frequency(DETAILED, {}) / _frequency(DESIGN, {})


def _solved(
    plant: ContinuousBlock,
    frequency: Callable[[float], float],
    wanted: float,
    low: float,
    high: float,
    what: str = "frequency",
    unit: str = " Hz",
) -> float:
    """The value at which a frequency of a plant, or another quantity that grows with it, is the one that is wanted.

    Raises:
        _DoesNotFollow: there is none between low and high.
    """

    def missed(x: float) -> float:
        return log(frequency(exp(x)) / wanted)

    solution = _by_secants(missed, log(low), log(high))
    if solution is not None:
        return exp(solution)
    least, most = frequency(low), frequency(high)
    if least <= wanted <= most:
        from scipy.optimize import brentq  # pyright: ignore[reportUnknownVariableType]

        x = float(brentq(missed, log(low), log(high), xtol=1e-9))  # pyright: ignore[reportArgumentType]
        if _close(frequency(exp(x)), wanted):  # and no leap to another mode
            return exp(x)
    raise _DoesNotFollow(
        f"the {what} of the drive train would have to be {wanted:.3g}{unit}, and that of {plant.name} can be "
        f"{least:.3g} to {most:.3g}{unit}"
    )


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


def _others_than_usual(values: Mapping[str, float]) -> dict[str, float]:
    """What has followed, rounded, where it is not that of the default car."""
    rounded = {name: float(f"{value:.{DIGITS}g}") for name, value in values.items()}
    return {name: value for name, value in rounded.items() if value != DEFAULT_CAR[name]}


def _told(car: Mapping[str, float], *names: str) -> str:
    """Those of the names that the car has, with value and unit."""
    return ", ".join(f"{name} = {car[name]:g} {OF_CAR[name][1].unit}".rstrip() for name in names if name in car)


def _number(name: str, value: Any) -> float:
    """The value as the models take it; the numbers of NumPy answer comparisons with what is no bool.

    Raises:
        ParameterFileError: it is no number.
    """
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ParameterFileError(f"{name} = {value!r:.40}: it must be a number") from None


def _require_possible(name: str, value: float) -> None:
    if impossible := _impossible(name, value):
        raise NoSuchCar(f"{name} = {value:g}: {impossible}", name)


def _impossible(name: str, value: float) -> str:
    """Who does not take the value, and what it takes."""
    block, variable = OF_CAR[name]
    low, high = variable.bounds()
    return "" if low <= value <= high else f"{block} takes {variable.allowed()}"

"""What identification leaves behind: a vehicle file for the controller's design, and a document with all of it."""

from collections.abc import Mapping
from textwrap import wrap
from typing import Any, NamedTuple

import numpy as np

from ...fmus.building.one_car import updated
from ..recordings.source import RecordingError
from .drive_train import DELAYS, Parameters
from .drive_train_response import PEAK, resonance
from .identify import WITH_LOAD, WITHOUT_LOAD, Identified
from .quality import Z_95
from .two_mass_equivalent import equivalent

UNITS = {
    "J_1": "kg.m2",
    "J_2": "kg.m2",
    "C": "N.m/rad",
    "d": "N.m.s/rad",
    "phi_B": "rad",
    "tau": "s",
    "late_1": "s",
    "late_T": "s",
    "late_L": "s",
}
"""Of what has one."""

MEANS = {
    WITH_LOAD: "J_2 is that of the wheels alone, C that between motor and wheels",
    WITHOUT_LOAD: "J_2 carries the vehicle, C has its tyres in it",
}

WIDEST_INTERVAL = 0.5
"""Half of a 95 % interval over its value, up to which a parameter is one of a vehicle file."""

NOT_DETERMINED = "is not determined"

SHORT = 2e-4
"""Half of an interval in s that tells something of a delay, though it holds 0."""

WIDEST = 118
"""Characters of a line of text in a vehicle file."""


class Interval(NamedTuple):
    """95 % interval of a parameter.

    Attributes:
        half: of its width.
        determined: whether it tells anything. Else the value is not to be shown.
    """

    name: str
    value: float
    half: float
    determined: bool

    def __str__(self) -> str:
        """With its unit, to stand after the name."""
        return f"= {self.value:.5g} +- {self.half:.2g} {self.unit}".rstrip() if self.determined else NOT_DETERMINED

    @property
    def unit(self) -> str:
        """Empty if it has none."""
        return UNITS.get(self.name, "")

    @property
    def percent(self) -> str:
        """The half over the value in %; empty of a delay, of which 0 is as good a value as another."""
        return "" if self.name in DELAYS else f"{100.0 * self.half / abs(self.value):.2g}"


def found(identified: Identified) -> list[Interval]:
    """Of each parameter that was identified. Where J_2 or C is not determined, nothing of the drive train is: a model
    without wheels, or of another car, fits as well, and its gains and delays mean nothing."""
    values = identified.p._asdict()
    halves = {name: Z_95 * deviation for name, deviation in identified.deviations.items() if deviation > 0.0}
    tells = {name: _tells(name, float(values[name]), half) for name, half in halves.items()}
    known = all(tells.get(name, True) for name in ("J_2", "C"))
    rows = [
        Interval(name, float(values[name]), halves[name], known and tells[name]) for name in values if name in halves
    ]
    if identified.loop:
        tau, half = identified.loop.loop.tau, Z_95 * identified.loop.deviations["tau"]
        rows.append(Interval("tau", tau, half, _tells("tau", tau, half)))
    return rows


def _tells(name: str, value: float, half: float) -> bool:
    return half <= max(abs(value), SHORT if name in DELAYS else 0.0)


def _is_known(rows: list[Interval]) -> bool:
    """The drive train."""
    return all(row.determined for row in rows if row.name in ("J_2", "C"))


def peak(identified: Identified) -> str:
    """The frequency in Hz at which the car answers most, or that the recording does not tell it."""
    frequency = identified.resonance
    return f"{frequency:.2f}" if _is_known(found(identified)) and PEAK[0] < frequency < PEAK[1] else NOT_DETERMINED


def of_car(identified: Identified) -> tuple[float, float]:
    """C of the vehicle file in N.m/rad, that of two masses which answer as the car does on its own, and half of its
    95 % interval, by the covariance of what was identified and the tyre as it is."""
    p, tyre = identified.p, identified.tyre

    def C(p: Parameters) -> float:
        return equivalent(p, tyre, resonance(p, tyre)).C

    deviations = identified.deviations
    moved = (
        {side: p._replace(**{name: getattr(p, name) + side * by}) for side in (-1, 1)}
        for name, by in deviations.items()
    )
    changes = np.array([0.5 * (C(each[1]) - C(each[-1])) for each in moved])
    scale = np.array(list(deviations.values()))
    variance = changes @ (identified.covariance / np.outer(scale, scale)) @ changes
    return C(p), Z_95 * float(np.sqrt(variance))


def of_car_line(identified: Identified) -> str:
    """Which C is for what, where there are two; and where there should be, that there is one."""
    C, half = of_car(identified)
    means = (
        "of two masses that answer as the car does, tyres in it"
        if identified.tyre
        else "of the drive train alone, as no tyre is found behind it; that with tyres is another"
    )
    return f"in the vehicle file C = {C:.5g} +- {half:.2g} N.m/rad ({100.0 * half / C:.2g} %): {means}"


def identified_lines(identified: Identified) -> list[str]:
    """What was found, for people, a line each: parameters with unit and 95 % interval, and how they fit."""
    quality = identified.quality
    every = found(identified)
    width = max(len(row.name) for row in every)
    explained = identified.method == "prediction error"
    expected = "1 if all is right" if explained else "over what the free runs are off by"
    shares = [f" ({row.percent} %)" if row.determined and row.percent else "" for row in every]
    answers = peak(identified)
    where = (
        f"the frequency at which the car answers most {answers}"
        if answers == NOT_DETERMINED
        else (f"the car answers most at {answers} Hz")
    )
    return [
        f"identified {identified.name}, by {identified.method}: {MEANS[identified.name]}; 95 % intervals",
        *(f"  {row.name:{width}} {row}{share}" for row, share in zip(every, shares, strict=True)),
        *([of_car_line(identified)] if identified.name == WITH_LOAD and _is_known(every) else []),
        where,
        f"fit to the last quarter, which was not used: simulated 0.5 s {quality.simulated:.1f} %, "
        f"predicted 50 ms {quality.predicted:.1f} %, one step {quality.one_step:.1f} %",
        f"innovations: size {quality.size:.2f} ({expected}), correlation {quality.correlation:.2f} (0 if white)",
    ]


def identified_car(identified: Identified, vehicle: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Entries of the vehicle file, in SI units: what the controller's model needs, as `design` takes it. What is known
    to no better than WIDEST_INTERVAL is not among them.

    Args:
        vehicle: entries of the one that was given, which stay but for those that were identified and those of the
            shafts, which follow from C.

    Raises:
        RecordingError: C is not known any better.
    """
    C, half = of_car(identified)
    every = found(identified)
    if not (_is_known(every) and half <= WIDEST_INTERVAL * C):
        known = (
            f"= {C:.3g} +- {half:.2g} N.m/rad is known to +- {100.0 * half / C:.2g} % only"
            if _is_known(every)
            else NOT_DETERMINED
        )
        raise RecordingError(
            f"C of the car {known}, and a vehicle file needs +- {100.0 * WIDEST_INTERVAL:g} % or less: excite more or "
            "longer, and give every channel as it was sampled"
        )
    rows = {row.name: row.value for row in every if row.half <= WIDEST_INTERVAL * row.value}
    entries = {"C": C, **{name: rows[name] for name in ("phi_B", "J_1", "tau") if name in rows}}
    return updated(vehicle or {}, {name: float(f"{value:.6g}") for name, value in entries.items()})


def vehicle_file(identified: Identified, comment: str, vehicle: Mapping[str, Any] | None = None) -> str:
    """The text of the vehicle file, TOML with the entries of `identified_car` under what was identified.

    Args:
        comment: how it begins.
        vehicle: see `identified_car`.
    """
    known = [
        *identified_lines(identified),
        *(f"warning: {warning}" for warning in identified.warnings),
        "",
        "What follows is for the design and both plants: C is that of the two masses that answer as the car does on",
        "its own, tyre and vehicle included; the shafts of the validation vehicle follow from it. J_2 stays as it was.",
    ]
    lines = [part for line in [*comment.splitlines(), "", *known] for part in wrap(line, WIDEST) or [""]]
    head = "\n".join(f"# {line}".rstrip() for line in lines)
    entries = identified_car(identified, vehicle)
    return f"{head}\n\n" + "".join(
        f"{name} = {'true' if value is True else 'false' if value is False else repr(value)}\n"
        for name, value in entries.items()
    )


def document(identified: Identified) -> dict[str, Any]:
    """All that was found, in SI units."""
    p: Parameters = identified.p
    return {
        "identified": identified.name,
        "method": identified.method,
        "parameters": {name: float(value) for name, value in p._asdict().items()},
        "free": list(identified.free),
        "standard_deviations": dict(identified.deviations),
        "covariance": identified.covariance.tolist(),
        "torque_loop": _loop(identified),
        "tyre": vars(identified.tyre) if identified.tyre else None,
        "intervals_95": {
            row.name: {"value": row.value, "half": row.half, "determined": row.determined} for row in found(identified)
        },
        "resonance_Hz": identified.resonance,
        "vehicle_file": identified_car(identified),
        "C_of_the_car": dict(zip(("value", "half"), of_car(identified), strict=True)),
        "equivalent": equivalent(p, identified.tyre, identified.resonance)._asdict(),
        "fit": vars(identified.quality),
        "warnings": list(identified.warnings),
    }


def _loop(identified: Identified) -> dict[str, Any] | None:
    if identified.loop is None:
        return None
    loop = identified.loop
    return {**vars(loop.loop), "standard_deviations": dict(loop.deviations), "noise": loop.noise}

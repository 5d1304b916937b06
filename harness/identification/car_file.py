"""What identification leaves behind: a vehicle file for the controller's design, and a document with all of it."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from driverecords.source import RecordingError
from driverecords.thresholds import Threshold

from ...fmus.building.car_entries import vehicle_text
from ...fmus.building.one_car import updated
from .drive_train import DELAYS, Parameters
from .estimator import Z_95
from .free_runs import SIMULATED
from .identify import WITH_LOAD, WITHOUT_LOAD, Identified
from .priors import OF_CAR, PRIORS
from .step import Step
from .two_mass_equivalent import equivalent

BESIDE = {"tau": "lag of motor control", "late_2": "age of the wheel speed"}
"""Times in s that the filter does not know, by what they mean."""

MEANS = {
    WITH_LOAD: "J_2 is that of the wheels alone, C that between motor and wheels",
    WITHOUT_LOAD: "J_2 carries the vehicle, C has its tyres in it",
}

WIDEST_INTERVAL = Threshold(
    0.5,
    "1",
    "half of the 95 % interval of a parameter over its value, above which it is not written",
    "the parameter may be half as large then, or half as large again",
)


def meaning(identified: Identified) -> str:
    """What J_2 and C are."""
    if identified.name == WITH_LOAD and not identified.explained:
        return "J_2 and C are those that predict best and not the car's, as the model does not explain all"
    return MEANS[identified.name]


class Row(NamedTuple):
    """What is known of a parameter.

    Attributes:
        half: of its 95 % interval.
        told_by: the channel that tells it; "" if none does, so that it is what is known of cars.
    """

    name: str
    value: float
    half: float
    told_by: str

    def __str__(self) -> str:
        """With its unit, to stand after the name."""
        return f"= {self.value:.5g} +- {self.half:.2g} {self.unit}".rstrip()

    @property
    def meaning(self) -> str:
        return PRIORS[self.name].meaning if self.name in PRIORS else BESIDE[self.name]

    @property
    def unit(self) -> str:
        """Empty if it has none."""
        unit = PRIORS[self.name].unit if self.name in PRIORS else "s"
        return unit.removeprefix("1")

    @property
    def percent(self) -> str:
        """The half over the value in %; empty of what may be 0 as well."""
        signed = self.name in (*DELAYS, "late_2", "d")
        return "" if signed else f"{100.0 * self.half / abs(self.value):.2g}"


def rows_of(identified: Identified) -> list[Row]:
    """Of each parameter that was identified."""
    answer, p = identified.found, identified.p._asdict()
    halves = {name: Z_95 * deviation for name, deviation in answer.deviations.items()}
    told = {name: answer.told_by(name) for name in OF_CAR if name in halves}
    if by := identified.plant_fit:
        p["phi_B"], halves["phi_B"], told["phi_B"] = *_value_and_half(by, "phi_B"), "motor speed"
    elif not identified.explained and "phi_B" in halves:
        halves["phi_B"] = max(halves["phi_B"], identified.unconfirmed * p["phi_B"])
    rows = [Row(name, float(p[name]), halves[name], channel) for name, channel in told.items()]
    if identified.loop:
        tau, half = identified.loop.loop.tau, Z_95 * identified.loop.deviations["tau"]
        rows.append(Row("tau", tau, half, "torque demand"))
    if late := identified.late_wheel_speed:
        rows.append(Row("late_2", late.time, Z_95 * late.deviation, "wheel speed"))
    return rows


def _value_and_half(fit: Step, name: str) -> tuple[float, float]:
    return fit.values[name], fit.values[name] * fit.halves[name]


def of_car(identified: Identified) -> tuple[float, float]:
    """C of the vehicle file in N.m/rad, and half of its 95 % interval: of the plant that was driven, else by the
    covariance."""
    if identified.plant_fit:
        return _value_and_half(identified.plant_fit, "C")
    p, answer = identified.p, identified.found

    def C(p: Parameters) -> float:
        return equivalent(identified, p).C

    # a step inside the bounds: d may be 0
    steps = {name: 0.1 * by for name, by in answer.deviations.items() if name in OF_CAR}
    changes = np.array([(C(p._replace(**{name: getattr(p, name) + by})) - C(p)) / by for name, by in steps.items()])
    at = [answer.free.index(name) for name in steps]
    return C(p), Z_95 * float(np.sqrt(changes @ answer.covariance[np.ix_(at, at)] @ changes))


def of_car_line(identified: Identified) -> str:
    """What C is in the vehicle file, and why."""
    C, half = of_car(identified)
    why = (
        "J_2 and C as they were found, as the model explains the car"
        if identified.explained
        else "J_2 as it was, as the model does not explain all; with that C the design's car swings as this one does"
    )
    why += f" ({identified.plant_fit.plant} driven by the recorded torque)" if identified.plant_fit else ""
    return f"in the vehicle file C = {C:.5g} +- {half:.2g} N.m/rad ({100.0 * half / C:.2g} %): {why}"


def identified_lines(identified: Identified) -> list[str]:
    """What was found, for people, a line each: parameters with unit, 95 % interval and what told them, and how they
    fit."""
    quality, rows = identified.quality, rows_of(identified)
    name, number = max(len(row.name) for row in rows), max(len(str(row)) for row in rows)
    told = [f"told by {row.told_by}" if row.told_by else "not told: what is known of cars" for row in rows]
    shares = [f"({row.percent} %)" if row.percent else "" for row in rows]
    load = "" if np.isnan(quality.T_load) else f", load torque {quality.T_load:.1f} %"
    size_L = "" if np.isnan(quality.T_load) else f", load torque {quality.size_L:.2f}"
    return [
        f"identified {identified.name}: {meaning(identified)}; 95 % intervals",
        *(
            f"  {row.name:{name}} {row!s:{number}} {share:9} {by}"
            for row, share, by in zip(rows, shares, told, strict=True)
        ),
        of_car_line(identified),
        f"the car answers most at {identified.resonance:.2f} Hz",
        f"fit to the last quarter, which was not used, simulated {SIMULATED:g} s from the motor torque alone: "
        f"motor speed {quality.omega_1:.1f} %{load}",
        f"innovations: motor speed {quality.size_1:.2f}{size_L} (1 if all is right)",
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
    rows = {row.name: row for row in rows_of(identified)}
    if not rows["C"].told_by or half > WIDEST_INTERVAL * C:
        raise RecordingError(
            f"C of the car = {C:.3g} +- {half:.2g} N.m/rad is known to +- {100.0 * half / C:.2g} % only, and a vehicle "
            f"file needs +- {100.0 * WIDEST_INTERVAL:g} % or less: excite more or longer, and give every channel as it "
            "was sampled"
        )
    known = {name: row.value for name, row in rows.items() if row.told_by and row.half <= WIDEST_INTERVAL * row.value}
    names = ("J_2", "phi_B", "J_1", "tau") if identified.explained else ("phi_B", "J_1", "tau")
    entries = {"C": C, **{name: known[name] for name in names if name in known}}
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
        "What follows is for the design and both plants; the shafts of the validation vehicle follow from C.",
    ]
    return vehicle_text([*comment.splitlines(), "", *known], identified_car(identified, vehicle))


def document(identified: Identified) -> dict[str, Any]:
    """All that was found, in SI units."""
    answer, loop, tyre = identified.found, identified.loop, identified.tyre_of(identified.p)
    return {
        "identified": identified.name,
        "parameters": {name: float(value) for name, value in identified.p._asdict().items()},
        "free": list(answer.free),
        "standard_deviations": answer.deviations,
        "covariance": answer.covariance.tolist(),
        "intervals_95": {
            row.name: {"value": row.value, "half": row.half, "told_by": row.told_by} for row in rows_of(identified)
        },
        "torque_loop": loop and {**vars(loop.loop), "standard_deviations": loop.deviations, "noise": loop.noise},
        "tyre": tyre and vars(tyre),
        "resonance_Hz": identified.resonance,
        "vehicle_file": identified_car(identified),
        "C_of_the_car": dict(zip(("value", "half"), of_car(identified), strict=True)),
        "driven_plant": identified.plant_fit and vars(identified.plant_fit),
        "equivalent": equivalent(identified, identified.p)._asdict(),
        # JSON has no NaN
        "fit": {name: value for name, value in vars(identified.quality).items() if not np.isnan(value)},
        "warnings": list(identified.warnings),
    }

"""What an identification is worth: accuracy, intervals, starts and bad data, by the dozen.

Each case drives the car, writes the recording as its sensors would, reads it and identifies it, as a user does.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from math import log
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np

from docs.studies.foreign_loop import Car, drawn, driven, logged
from driveline.fmus.building.parameter_files import read_vehicle
from driveline.harness.design import redesign
from driveline.harness.design.design import design
from driveline.harness.design.design_weights import MOTOR, PLANT, records
from driveline.harness.design.loop_parameters import loop_parameters
from driveline.harness.design.redesign import REDESIGN_MANOEUVRES
from driveline.harness.identification.car_file import identified_car, rows_of
from driveline.harness.identification.drive_train_response import response
from driveline.harness.identification.estimator import Z_95, Found, search
from driveline.harness.identification.identify import FREE, Identified, of_sensors
from driveline.harness.identification.model_inputs import drive_of
from driveline.harness.identification.prediction import Predictor
from driveline.harness.identification.prior_knowledge import identify, known
from driveline.harness.identification.priors import before
from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.prbs import TEST_DRIVE, TEST_SPEED, binary_torque
from driveline.harness.simulation.excitation_drive import MeasurementWheels, sensed
from driveline.harness.simulation.simulate import simulate
from driveline.harness.studies.margins.linear_plant import linear_plant as linear
from driveline.harness.studies.margins.operating_point import Point
from driveline.models import validation_vehicle
from driverecords.measurement import Measurement, read_measurement
from toolground.csv_file import write_csv

DESIGN_MODEL, VEHICLE = PLANTS

WHEELS = MeasurementWheels()
"""With their errors."""

TRUE = {name: float(getattr(PLANT, name)) for name in ("J_1", "J_2", "C", "phi_B")} | {"tau": MOTOR.tau}
"""Of the default car."""

WIDE = {"J_2": (0.05, 2.0), "C": (30.0, 450.0), "phi_B": (1e-3, 0.4)}
"""Between which wide starts are drawn, by the logarithm."""


def recording(
    plant: str,
    seed: int,
    parameters: Mapping[str, float] | None = None,
    wheels: MeasurementWheels = WHEELS,
    car: Mapping[str, Any] | None = None,
) -> Measurement:
    """A test drive as recorded.

    Args:
        car: entries of its vehicle file.
    """
    of, _, _ = records(car or {})
    drive = binary_torque("prbs", **TEST_DRIVE, v_0=TEST_SPEED / 3.6)
    of_loop = loop_parameters(car or {}, plant) | dict(parameters or {})
    results = simulate(drive, plant, control=False, parameters=of_loop, seed=seed)
    with TemporaryDirectory() as folder:
        path = Path(folder, f"{plant}_{seed}.csv")
        write_csv(sensed(results, of.i, wheels, seed), path)
        return read_measurement(path, of.i, of.r)


@dataclass(frozen=True)
class Answer:
    """Attributes:
    values, deviations: of the free parameters and tau.
    warnings: of the identification.
    quality: see `Identified`.
    resonance: in Hz.
    seconds: of the processor that it took.
    """

    values: Mapping[str, float]
    deviations: Mapping[str, float]
    warnings: tuple[str, ...]
    quality: Mapping[str, float]
    resonance: float
    seconds: float

    def z(self, name: str, true: float) -> float:
        """By how many standard deviations the answer is off."""
        return (self.values[name] - true) / self.deviations[name]


def identified(recorded: Measurement, vehicle: Mapping[str, float], more: Sequence[str] = ()) -> Answer:
    """
    Args:
        vehicle: what is known of the car.
    """
    began = process_time()
    return answer_of(identify(recorded, vehicle, more), process_time() - began)


def answer_of(identified: Identified, seconds: float) -> Answer:
    values = {name: float(value) for name, value in identified.p._asdict().items()}
    deviations = dict(identified.found.deviations)
    phi_B = next(row for row in rows_of(identified) if row.name == "phi_B")
    values["phi_B"], deviations["phi_B"] = phi_B.value, phi_B.half / Z_95
    if identified.loop:
        values["tau"], deviations["tau"] = identified.loop.loop.tau, identified.loop.deviations["tau"]
    return Answer(values, deviations, identified.warnings, asdict(identified.quality), identified.resonance, seconds)


def accuracy(case: tuple[int, tuple[str, ...]]) -> Answer:
    """Of the design model: seed, and what is free beside."""
    seed, more = case
    return identified(recording(DESIGN_MODEL, seed), {}, more)


def from_random_starts(case: int) -> Answer:
    """From a start that is drawn wide."""
    rng = np.random.default_rng(case)
    start = {name: float(np.exp(rng.uniform(log(low), log(high)))) for name, (low, high) in WIDE.items()}
    return identified(recording(DESIGN_MODEL, case), start)


@dataclass(frozen=True)
class Covered:
    """A recording of a foreign loop.

    Attributes:
        amplitude: of the demand in N.m.
        skewed: whether channels are late.
        off: what was found less the truth, in its unit.
        true: the truth.
        deviations: standard deviations.
        bound: those of the Cramer-Rao bound, with the noise of the sensors and the torque as recorded.
    """

    amplitude: float
    skewed: bool
    off: Mapping[str, float]
    true: Mapping[str, float]
    deviations: Mapping[str, float]
    bound: Mapping[str, float]


def covered(case: tuple[int, int, bool]) -> list[Covered]:
    """Recordings of cars and loops that are drawn: seed, how many, and whether nothing is known of the car; else the
    search begins at the truth, for what the intervals hold does not depend on where it begins."""
    seed, count, from_anywhere = case
    cars, loops = drawn(count, seed)
    seeds = [1000 * seed + k for k in range(count)]
    every, answers = driven(cars, loops, seeds), []
    for k, (car, loop) in enumerate(zip(cars, loops, strict=True)):
        with TemporaryDirectory() as folder:
            path = Path(folder, "drive.csv")
            logged(every[..., k], car, loop, seeds[k], path)
            recorded = read_measurement(path, car.i, car.r)
        late_T, late_L = loop.shifts
        true = {"J_2": car.J_2, "C": car.C, "phi_B": car.phi_B, "late_T": late_T, "late_L": late_L}
        estimate = identify(recorded, car.known).found if from_anywhere else from_truth(recorded, car, true)
        off = {name: getattr(estimate.p, name) - value for name, value in true.items()}
        answers.append(Covered(loop.amplitude, bool(k % 2), off, true, estimate.deviations, bound(estimate)))
    return answers


def from_truth(recorded: Measurement, car: Car, true: Mapping[str, float]) -> Found:
    """What is found by a search that begins at the true parameters."""
    expected, behind = known(car.known)
    drive, _ = drive_of(recorded)
    predictor = Predictor(drive, of_sensors(drive, recorded.T_mot), behind)
    start = expected._replace(d=0.04, lack_1=0.15, lack_phi=1e-3, lack_L=1.0, **true)
    return search(predictor, start, FREE, expected._replace(d=expected.damping))


def bound(estimate: Found) -> dict[str, float]:
    """Cramer-Rao bound of the standard deviations, with what is known before; without what the model lacks."""
    keep = [k for k, name in enumerate(estimate.free) if not name.startswith("lack_")]
    information = estimate.information.sum(axis=0) + np.diag(before(estimate.free))
    inverse = np.linalg.inv(information[np.ix_(keep, keep)])
    deviations = np.sqrt(np.diag(inverse)) * estimate.scale[keep]
    return {estimate.free[k]: float(deviation) for k, deviation in zip(keep, deviations, strict=True)}


SHORT = 4.0
"""Duration in s of the recording that is identified again."""


def short(seed: int) -> Found:
    """The first recording of a foreign loop with this seed, shorter, searched from the truth."""
    (car, *_), (loop, *_) = drawn(1, seed)
    with TemporaryDirectory() as folder:
        path = Path(folder, "drive.csv")
        logged(driven([car], [loop], [seed], SHORT)[..., 0], car, loop, seed, path, SHORT)
        recorded = read_measurement(path, car.i, car.r)
    return from_truth(recorded, car, {"J_2": car.J_2, "C": car.C, "phi_B": car.phi_B})


@dataclass(frozen=True)
class Trap:
    """Bad data.

    Attributes:
        name: of what is wrong.
        cause: a word of the warning that names it; none: the answer must be right.
        parameters: of the blocks.
        wheels: the measurement wheels.
        late: of channels in s, a straight line between their samples.
        J_1: that is taken as known, over the true one.
    """

    name: str
    cause: str
    parameters: Mapping[str, float]
    wheels: MeasurementWheels = WHEELS
    late: Mapping[str, float] = field(default_factory=dict)
    J_1: float = 1.0


TRAPS = (
    Trap("nothing", "", {}),
    Trap("wheel speed 25 ms later over CAN", "", {"can.d_min": 0.026, "can.d_max": 0.05}),
    Trap("load torque 4 ms late", "load torque comes", {}, late={"T_load": 0.004}),
    Trap("motor speed 2 ms late, a sample", "motor speed comes", {}, late={"omega_1": 0.002}),
    Trap("motor speed 1 ms late, between samples", "motor speed has no white noise", {}, late={"omega_1": 0.001}),
    Trap("J_1 taken 3 % too large", "J_1", {}, J_1=1.03),
    Trap("tau half as long again", "tau", {"motor.tau": 0.0045}),
    Trap("motor torque recorded 3 % too large", "motor torque looks", {"motor.g_T": 1.03}),
    Trap("offsets 1.5 N.m (motor) and 40 N.m (wheels)", "", {"motor.o_T": 1.5}, MeasurementWheels(offset=40.0)),
)


def trapped(case: tuple[int, int]) -> Answer:
    """With bad data: number of the trap, seed."""
    trap, seed = TRAPS[case[0]], case[1]
    recorded = recording(DESIGN_MODEL, seed, trap.parameters, trap.wheels)
    time = recorded.time
    late = {name: np.interp(time - by, time, getattr(recorded, name)) for name, by in trap.late.items()}
    return identified(replace(recorded, **late), {"J_1": TRUE["J_1"] * trap.J_1})


@dataclass(frozen=True)
class Judged:
    """A detailed car as identified, against the truth.

    Attributes:
        answer: from the recording.
        phi_B: half the gap over the true one.
        peak: true frequency in Hz at which the car answers most.
        response: of the car on its own, rms of the difference in dB over RESPONSE.
        gains: settling time and overshoot with the gains of the identified car, over those with the gains of the true
            one, means over REDESIGN_MANOEUVRES.
    """

    answer: Answer
    phi_B: float
    peak: float
    response: float
    gains: tuple[float, float]


RESPONSE = np.linspace(2.0, 12.0, 1001)
"""Frequencies in Hz at which responses are compared."""


CARS = {"default": {}} | {
    name: read_vehicle(Path(f"examples/cars/{name}.toml")) for name in ("small", "mid_size", "van")
}
"""Entries of their vehicle files."""


def judged(case: tuple[str, int, bool]) -> Judged:
    """One of CARS, seed, and whether the load torque is measured. Known before are the entries of its file but for C,
    phi_B and tau, which are those of the default car."""
    name, seed, measured = case
    car = CARS[name]
    recorded = recording(VEHICLE, seed, car=car)
    recorded = recorded if measured else replace(recorded, T_load=None)
    before = {entry: value for entry, value in car.items() if entry not in ("C", "phi_B", "tau")}
    began = process_time()
    identified = identify(recorded, before)
    answer = answer_of(identified, process_time() - began)
    true = true_response(name)
    off = 20.0 * np.log10(abs(response(identified.p, RESPONSE, identified.tyre_of(identified.p)) / true))
    own, others = worth(car, identified_car(identified, before)), worth(car, car)
    return Judged(
        answer,
        answer.values["phi_B"] / records(car)[0].phi_B,
        float(RESPONSE[int(np.argmax(abs(true)))]),
        float(np.sqrt(np.mean(off**2))),
        (own[0] / others[0], own[1] / others[1]),
    )


def worth(car: Mapping[str, Any], assumed: Mapping[str, Any]) -> tuple[float, float]:
    """Mean settling time in s and overshoot of a detailed car with the gains of the car that is assumed."""
    gains = {**assumed, **design(assumed)}
    settling, overshoot = np.mean([redesign.worth(VEHICLE, name, car, gains) for name in REDESIGN_MANOEUVRES], axis=0)
    return float(settling), float(overshoot)


@cache
def true_response(name: str) -> np.ndarray:
    """omega_1 over T_mot of one of CARS in contact, at RESPONSE."""
    by_instance: dict[str, dict[str, Any]] = {}
    for entry, value in loop_parameters(CARS[name], VEHICLE).items():
        instance, _, parameter = entry.partition(".")
        by_instance.setdefault(instance, {})[parameter] = value
    torque = TEST_DRIVE["mean"] + TEST_DRIVE["amplitude"]
    car = linear(Point(plant=validation_vehicle.BLOCK, parameters=by_instance, T=torque))
    s = 2j * np.pi * RESPONSE
    x = np.array([np.linalg.solve(at * np.eye(len(car.A)) - car.A, car.B) for at in s])
    T_mot, omega_1 = (x @ car.rows([signal])[0] for signal in ("T_mot_est", "omega_1"))
    return omega_1 / T_mot

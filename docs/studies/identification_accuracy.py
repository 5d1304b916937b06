"""What an identification is worth: accuracy, intervals, starts, bad data and redesigned controllers, by the dozen.

Each case drives the car, writes the recording as its sensors would, reads it and identifies it, as a user does.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from math import log
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic

import numpy as np

from docs.studies.foreign_loop import CARS, Loop, logged
from driveline.harness.base.csv_file import write_csv
from driveline.harness.design.design import design
from driveline.harness.design.design_trials import controller_parameters, loop_records, settled
from driveline.harness.design.design_weights import MOTOR, PLANT
from driveline.harness.design.kalman import DesignError
from driveline.harness.design.redesign import REDESIGN_MANOEUVRES, softened
from driveline.harness.design.uncertainty_box import Deviation, changed
from driveline.harness.identification.car_file import identified_car
from driveline.harness.identification.drive_train import Parameters
from driveline.harness.identification.drive_train_response import response
from driveline.harness.identification.identify import (
    UNMEASURED,
    WITHIN,
    Identified,
    coarse_fit,
    identify,
    of_sensors,
    output_error_fit,
    prediction_error_fit,
)
from driveline.harness.identification.model_inputs import model_inputs
from driveline.harness.identification.prediction import filtered
from driveline.harness.identification.prior_knowledge import identify as known_car
from driveline.harness.identification.quality import near_starts, nrmse, segments
from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.prbs import TEST_DRIVE, TEST_SPEED, binary_torque
from driveline.harness.metrics.evaluate import at_samples
from driveline.harness.recordings.filters import low
from driveline.harness.recordings.measurement import Measurement, read_measurement
from driveline.harness.recordings.source import RecordingError
from driveline.harness.simulation.excitation_drive import MeasurementWheels, sensed
from driveline.harness.simulation.simulate import simulate
from driveline.harness.studies.margins.linear_plant import linear_plant as linear
from driveline.harness.studies.margins.operating_point import Point
from driveline.models import validation_vehicle

DESIGN_MODEL, VEHICLE = PLANTS

WHEELS = MeasurementWheels()
"""With their errors."""

KNOWN = Parameters(PLANT.J_1, PLANT.J_2, PLANT.C, 0.0, PLANT.phi_B)
"""The default car, with which the search begins."""

WIDE = {"J_2": (0.05, 2.0), "C": (30.0, 450.0), "phi_B": (1e-3, 0.4)}
"""Between which wide starts are drawn, by the logarithm."""


def recording(
    plant: str, seed: int, parameters: Mapping[str, float] | None = None, wheels: MeasurementWheels | None = None
) -> tuple[Measurement, np.ndarray]:
    """A test drive as recorded, and the true signals."""
    drive = binary_torque("prbs", **TEST_DRIVE, v_0=TEST_SPEED / 3.6)
    results = simulate(drive, plant, control=False, parameters=parameters, seed=seed)
    with TemporaryDirectory() as folder:
        path = Path(folder, f"{plant}_{seed}.csv")
        write_csv(sensed(results, PLANT.i, wheels or WHEELS, seed), path)
        return read_measurement(path, PLANT.i, PLANT.r), results


def identified(recorded: Measurement, start: Parameters = KNOWN, more: Sequence[str] = ()) -> Identified:
    return identify(recorded, start, MOTOR.tau, PLANT.m * PLANT.r**2 / PLANT.i**2, more)


@dataclass(frozen=True)
class Found:
    """Attributes:
    values, deviations: of the free parameters and tau.
    warnings: of the identification.
    quality: fits in %.
    resonance: in Hz.
    seconds: that it took.
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


def found(recorded: Measurement, start: Parameters = KNOWN, more: Sequence[str] = ()) -> Found:
    began = monotonic()
    answer = identified(recorded, start, more)
    return _found(answer, monotonic() - began)


def _found(answer: Identified, seconds: float) -> Found:
    loop = answer.loop
    values = {name: float(value) for name, value in answer.p._asdict().items()}
    return Found(
        values | ({"tau": loop.loop.tau} if loop else {}),
        {**answer.deviations, **({"tau": loop.deviations["tau"]} if loop else {})},
        answer.warnings,
        asdict(answer.quality),
        answer.resonance,
        seconds,
    )


def accuracy(case: tuple[int, tuple[str, ...]]) -> Found:
    """Of the design model: seed, and what is free beside."""
    seed, more = case
    recorded, _ = recording(DESIGN_MODEL, seed)
    return found(recorded, more=more)


def from_random_starts(case: int) -> Found:
    """From a start that is drawn wide."""
    rng = np.random.default_rng(case)
    drawn = {name: float(np.exp(rng.uniform(log(low), log(high)))) for name, (low, high) in WIDE.items()}
    recorded, _ = recording(DESIGN_MODEL, case)
    return found(recorded, KNOWN._replace(**drawn))


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
    Trap("load torque 4 ms late", "load torque looks late", {}, late={"T_load": 0.004}),
    Trap("motor speed 2 ms late, a sample", "motor speed looks late", {}, late={"omega_1": 0.002}),
    Trap("motor speed 1 ms late, between samples", "motor speed has no white noise", {}, late={"omega_1": 0.001}),
    Trap("J_1 taken 3 % too large", "J_1", {}, J_1=1.03),
    Trap("tau half as long again", "tau", {"motor.tau": 0.0045}),
    Trap("motor torque recorded 3 % too large", "motor torque looks", {"motor.g_T": 1.03}),
    Trap("offsets 1.5 N.m (motor) and 40 N.m (wheels)", "", {"motor.o_T": 1.5}, MeasurementWheels(offset=40.0)),
)


def trapped(case: tuple[int, int]) -> Found:
    """With bad data: number of the trap, seed."""
    trap, seed = TRAPS[case[0]], case[1]
    recorded, _ = recording(DESIGN_MODEL, seed, trap.parameters, trap.wheels)
    time = recorded.time
    late = {name: np.interp(time - by, time, getattr(recorded, name)) for name, by in trap.late.items()}
    recorded = replace(recorded, **late)
    return found(recorded, KNOWN._replace(J_1=KNOWN.J_1 * trap.J_1))


def foreign(case: tuple[int, Loop, int]) -> tuple[Found, tuple[float, float]]:
    """In a loop that is not ours: number of the car, loop, seed. With the shifts of motor and load torque that were
    found, in s."""
    number, loop, seed = case
    car = CARS[number]
    with TemporaryDirectory() as folder:
        path = Path(folder, "drive.csv")
        logged(car, loop, seed, path)
        recorded = read_measurement(path, car.i, car.r)
    began = monotonic()
    answer = known_car(recorded, car.known)
    return _found(answer, monotonic() - began), answer.p.shifts


@dataclass(frozen=True)
class Judged:
    """The validation vehicle as identified, against the truth.

    Attributes:
        found: from the recording.
        simulated: NRMSE in % of omega_1 and omega_1 - omega_2 over 0.5 s on a recording with another seed.
        slow: the same below SLOW.
        response: rms of the difference in dB over RESPONSE: with the load as it is, and of the car on its own.
        peak: of the true response in Hz.
    """

    found: Found
    simulated: tuple[float, float]
    slow: tuple[float, float]
    response: tuple[float, float]
    peak: float


@dataclass(frozen=True)
class Method:
    """What a method makes of a recording.

    Attributes:
        p: the parameters.
        simulated: NRMSE in % of the motor speed in free runs over 0.5 s of another recording.
        seconds: that it took.
    """

    p: Parameters
    simulated: float
    seconds: float


def both_methods(case: tuple[str, int]) -> tuple[Method, Method]:
    """Prediction error and output error from the same start, on the same recording: plant, seed."""
    plant, seed = case
    recorded, _ = recording(plant, seed)
    drive, loop = model_inputs(recorded)
    noise = of_sensors(recorded, loop)
    other, _ = model_inputs(recording(plant, seed + 1000)[0])
    begun = coarse_fit(drive, KNOWN, noise)

    def method(of: Callable[[], Parameters]) -> Method:
        began = monotonic()
        p = of()
        seconds = monotonic() - began
        pieces = segments(other, (), WITHIN)
        runs, speed = pieces.free_runs(p, near_starts(pieces, filtered(other, p, noise)))
        return Method(p, nrmse(runs[..., 0] - speed, speed), seconds)

    return method(lambda: prediction_error_fit(drive, begun, noise).p), method(
        lambda: output_error_fit(drive, begun, noise).p
    )


SLOW = 12.0
"""In Hz."""

RESPONSE = np.linspace(2.0, 12.0, 201)
"""Frequencies in Hz at which responses are compared."""


def judged(case: tuple[int, bool]) -> Judged:
    """Seed, and whether the load torque is measured."""
    seed, measured = case

    def seen(seed: int) -> tuple[Measurement, np.ndarray]:
        recorded, truth = recording(VEHICLE, seed)
        return (recorded if measured else replace(recorded, T_load=None)), truth

    recorded, _ = seen(seed)
    began = monotonic()
    answer = identified(recorded)
    seconds = monotonic() - began
    held_out, truth = seen(seed + 1000)
    drive, _ = model_inputs(held_out)
    pieces = segments(drive, (), WITHIN if measured else UNMEASURED)
    near = near_starts(pieces, filtered(drive, answer.p, answer.noise))
    runs, _ = pieces.free_runs(answer.p, near)
    sampled = at_samples(truth)
    at = [slice(first + 1, first + 1 + pieces.length) for first in pieces.firsts]
    omega_1, omega_2 = (np.array([sampled[f"plant.{name}"][k] for k in at]) for name in ("omega_1", "omega_2"))
    errors = (runs[..., 0] - omega_1, runs[..., 0] - runs[..., 1] - omega_1 + omega_2)
    true = (omega_1, omega_1 - omega_2)

    def slow(x: np.ndarray) -> np.ndarray:
        return np.array([low(piece, drive.T_s, SLOW) for piece in x])

    def fits(of: Callable[[np.ndarray], np.ndarray]) -> tuple[float, float]:
        one, other = (nrmse(of(error), of(signal)) for error, signal in zip(errors, true, strict=True))
        return one, other

    peak = float(RESPONSE[int(np.argmax(abs(_true_response()[0])))])
    return Judged(_found(answer, seconds), fits(lambda x: x), fits(slow), _responses(answer), peak)


@cache
def _true_response() -> tuple[np.ndarray, np.ndarray]:
    """omega_1 and T_load over T_mot of the vehicle in contact, at RESPONSE."""
    car = linear(Point(plant=validation_vehicle.BLOCK, T=TEST_DRIVE["mean"] + TEST_DRIVE["amplitude"]))
    s = 2j * np.pi * RESPONSE
    x = np.array([np.linalg.solve(at * np.eye(len(car.A)) - car.A, car.B) for at in s])
    T_mot, omega_1, T_load = (x @ car.rows([name])[0] for name in ("T_mot_est", "omega_1", "T_load"))
    return omega_1 / T_mot, T_load / T_mot


def _responses(answer: Identified) -> tuple[float, float]:
    true, load = _true_response()
    p, s = answer.p, 2j * np.pi * RESPONSE
    shaft, wheels = p.C / s + p.d, p.J_2 * s
    with_load = (1.0 + load * shaft / (shaft + wheels)) / (p.J_1 * s + shaft * wheels / (shaft + wheels))
    alone = response(p, RESPONSE, answer.tyre)

    def off(found: np.ndarray) -> float:
        return float(np.sqrt(np.mean((20.0 * np.log10(abs(found / true))) ** 2)))

    return (off(with_load) if answer.tyre else np.nan), off(alone)


@dataclass(frozen=True)
class Redesigned:
    """A car drawn at random with the default gains and with those of its identification.

    Attributes:
        plant, number: of the draw.
        before, after: settling time in s and overshoot (1) by manoeuvre.
        found: C, phi_B and tau that the controller assumes.
        problem: why there is no controller.
    """

    plant: str
    number: int
    before: Mapping[str, tuple[float, float]]
    after: Mapping[str, tuple[float, float]]
    found: Mapping[str, float]
    problem: str = ""


def redesigned(case: tuple[str, int, Deviation, int]) -> Redesigned:
    """A draw of the box: plant, number, deviation, seed of the noise. Identified with load torque."""
    plant, number, deviation, seed = case
    blocks = {place: record()._asdict() for place, record in loop_records(plant).items()}
    true = changed(blocks, deviation)
    try:
        recorded, _ = recording(plant, seed, true)
        assumed = identified_car(identified(recorded))
    except RecordingError as reason:
        return Redesigned(plant, number, {}, {}, {}, str(reason))
    before = {name: settled(plant, name, true, seed) for name in REDESIGN_MANOEUVRES}
    try:
        gains = design(assumed, weights=softened(assumed, {}))
    except DesignError as reason:
        return Redesigned(plant, number, before, {}, assumed, str(reason))
    controller = controller_parameters({**assumed, **gains}, plant)
    after = {name: settled(plant, name, true | controller, seed) for name in REDESIGN_MANOEUVRES}
    return Redesigned(plant, number, before, after, assumed)

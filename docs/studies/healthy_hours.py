"""Hours of healthy driving: is any sample of them in fallback, and how near did the monitors come to it?

    python -m docs.studies healthy_hours --hours 24

Drives of a minute each, at random but reproducible: pedal, brake and slope, from parking to motorway, with
the sensor errors of the specification (noise, tolerances of torque and wheel radius, lost messages), on both
plants and on ice, where wheels spin and lock. The residuals of the monitors are shown over their thresholds.
"""

import argparse
from collections.abc import Iterable, Sequence
from functools import partial
from math import copysign
from typing import NamedTuple

import numpy as np

from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.signals import lines
from driveline.harness.simulation.simulate import simulate
from driveline.models.controller import T_S, causes, torque_loop, wheel_messages
from driveline.models.controller.supervision import FALLBACK, Input
from driveline.models.damping_controller import BLOCK
from driveline.models.physics.vehicle import added_speed
from driverecords.longest_interval import longest_run
from fmuloop.many_runs import run_many

from .study import Column, Measured, Study, Table
from .terminal import show

P = BLOCK.Parameters()
MINUTE = 60.0
TICK = round(T_S / 1e-3)


class Road(NamedTuple):
    """A plant on a surface: what the driver asks for at most, N.m at the motor and at the wheels, and dares to."""

    plant: str
    mu: float
    T_driver: float
    T_brake: float
    harsh: float


ROADS = {
    "design model": Road(PLANTS[0], 1.0, 180.0, 2400.0, 0.1),
    "vehicle": Road(PLANTS[1], 1.0, 180.0, 2400.0, 0.1),
    "vehicle on ice": Road(PLANTS[1], 0.1, 15.0, 200.0, 0.1),
}
HARSH_TORQUE, HARSH_BRAKE = 120.0, 4000.0
"""N.m that spin the wheels on ice, and lock them on any road; half a second of that now and then."""


class Found(NamedTuple):
    """What a drive showed: samples, those in fallback and with less damping, and the largest residuals over their
    thresholds."""

    samples: int
    fallback: int
    feeding: int
    jump: float
    contradiction: float
    torque: float
    frozen: float


def drive(road: Road, seed: int) -> tuple[Manoeuvre, dict[str, float]]:
    """A minute on the road, and the errors of the sensors."""
    random = np.random.default_rng(seed)
    v = v_0 = float(random.choice([0.0, random.uniform(1.0, 35.0)]))
    T = 0.0 if v == 0.0 else float(random.uniform(-0.2, 0.5) * road.T_driver)
    pedal, brake, t = [(0.0, T), (0.3, T)], [(0.0, 0.0), (0.3, 0.0)], 0.3
    while t < MINUTE:
        T, T_brake, lasts = action(road, v, random)
        rises = float(random.uniform(0.1 if T_brake else 0.002, 0.3))  # brakes take a tenth of a second
        pedal += [(t + rises, T), (t + rises + lasts, T)]
        brake += [(t + rises, T_brake), (t + rises + lasts, T_brake)]
        v = max(0.0, v + (rises + lasts) * acceleration(road, v, T, T_brake))
        t += rises + lasts
        if T == HARSH_TORQUE:  # wheels that spin are let go of
            pedal += [(t + 0.05, 0.0), (t + 1.5, 0.0)]
            brake += [(t + 1.5, 0.0)]
            t += 1.5
    name = f"healthy {seed}"
    slope = lines((0.0, 0.0), (1.0, float(random.uniform(-0.04, 0.04))))
    manoeuvre = Manoeuvre(name, "healthy driving", MINUTE, v_0, lines(*pedal), lines(*brake), slope)
    errors = {"can.g_w2": random.uniform(0.98, 1.02), "can.loss": random.choice([0.0, 0.1])}
    errors |= {"motor.g_T": random.uniform(0.95, 1.05), "motor.o_T": random.uniform(-1.5, 1.5)}
    return manoeuvre, {name: float(value) for name, value in errors.items()}


def action(road: Road, v: float, random: np.random.Generator) -> tuple[float, float, float]:
    """What the driver does next at the speed v (m/s): T_driver and T_brake in N.m, for how long in s."""
    dares = random.random() < road.harsh
    if v > 38.0 or (v > 2.0 and random.random() < 0.2):
        T_brake = HARSH_BRAKE if dares else float(random.uniform(0.1, 1.0) * road.T_brake)
        return float(random.uniform(-0.2, 0.0) * road.T_driver), T_brake, 0.5 if dares else random.uniform(0.3, 2.0)
    if v < 0.5 and random.random() < 0.5:
        return 0.0, 300.0, float(random.uniform(0.5, 2.0))
    if dares:
        return HARSH_TORQUE, 0.0, 0.5
    low = 0.1 if v < 2.0 else -0.25
    return float(random.uniform(low, 1.0) * road.T_driver), 0.0, float(random.choice([0.1, 0.5, 2.0]))


def acceleration(road: Road, v: float, T: float, T_brake: float) -> float:
    """Of the car as a point of mass, m/s2: only to keep it on the road."""
    force = np.clip((9.0 * T - T_brake) / 0.29, -8500.0 * road.mu, 8500.0 * road.mu)
    return float(force - 170.0 - 0.42 * v * v) / 1700.0


def residuals_on(road: Road, seed: int) -> Found:
    manoeuvre, errors = drive(road, seed)
    surface = {"plant.mu": road.mu} if road.mu != 1.0 else {}
    rows = simulate(manoeuvre, road.plant, parameters={**errors, **surface}, seed=seed)[::TICK]
    omega_1 = rows["motor.omega_1_meas"]
    return Found(
        samples=len(rows),
        fallback=int(np.count_nonzero(rows["controller.status"] == FALLBACK)),
        feeding=int(np.count_nonzero(rows["controller.cause"] == causes.FEEDS)),
        jump=float(jumps(omega_1).max()) / (P.jump * added_speed(P, T_S)),
        contradiction=contradiction(rows) / P.t_apart,
        torque=longest_run(disobeyed(rows))[1] * T_S / P.t_bad,
        frozen=longest_run((np.diff(omega_1) == 0.0) & (abs(omega_1[1:]) > P.omega_still))[1] * T_S / P.t_bad,
    )


def jumps(omega_1: np.ndarray) -> np.ndarray:
    """How far a speed is from that of the last sample, or from where that was going, in rad/s (motor_signals)."""
    return np.minimum(abs(np.diff(omega_1))[1:], abs(np.diff(omega_1, n=2)))


SIGNALS = {
    "omega_1_meas": "motor.omega_1_meas",
    "T_mot_est": "motor.T_mot_est",
    "omega_2_can": "can.omega_2_can",
    "valid": "can.valid",
    "counter": "can.counter",
}
"""What the messages are compared by, and where it is in the results."""


def contradiction(rows: np.ndarray) -> float:
    """Longest time in s for which the messages contradict the motor speed (wheel_messages)."""
    columns = (rows[column].tolist() for column in SIGNALS.values())
    inputs = [Input(**dict(zip(SIGNALS, row, strict=True))) for row in zip(*columns, strict=True)]
    x, way = wheel_messages.start(inputs[0], inputs[0].omega_1_meas, P), 1.0
    lasts, most = 0.0, 0.0
    for u in inputs:
        way = copysign(1.0, u.omega_1_meas) if abs(u.omega_1_meas) > P.omega_still else way
        x, _, contradicts = wheel_messages.update(x, u, u.omega_1_meas, False, lasts > 0.0, way, T_S, P)
        lasts = lasts + T_S if contradicts else 0.0
        most = max(most, lasts)
    return most


def disobeyed(rows: np.ndarray) -> np.ndarray:
    """Whether the torque estimate is far from what the motor should have (torque_loop)."""
    T_ref, T_mot_est = rows["controller.T_ref"].tolist(), rows["motor.T_mot_est"].tolist()
    x, far = torque_loop.LoopState(T_mot_est[0]), []
    for demand, estimate in zip(T_ref, T_mot_est, strict=True):
        far.append(not torque_loop.agrees(x, estimate, P))
        x = torque_loop.update(x, demand, T_S, P)
    return np.array(far)


def worst(drives: Iterable[Found]) -> Found:
    """The sum of the samples, the largest of the residuals."""
    columns = list(zip(*drives, strict=True))
    return Found(*map(sum, columns[:3]), *map(max, columns[3:]))


HOURS = 3.0
"""Shared by the roads."""

COLUMNS = (
    *(Column(name, decimals=0) for name in ("samples", "in fallback", "less damping")),
    *map(Column, ("jump", "contradiction", "torque", "frozen")),
)


def roads_table(hours: float) -> Table:
    """The largest residuals on each road, over the thresholds from which on they count as a fault."""
    drives = max(1, round(hours * 3600.0 / MINUTE / len(ROADS)))
    rows = {
        name: tuple(worst(run_many(partial(residuals_on, road), range(1, drives + 1), label=name)))
        for name, road in ROADS.items()
    }
    return Table("road", COLUMNS, rows, "From `jump` on: the largest residuals over their thresholds.")


def first_table() -> Table:
    """The first drive on each road."""
    return Table("road", COLUMNS, {name: tuple(residuals_on(road, 1)) for name, road in ROADS.items()})


def measure() -> Measured:
    return Measured({"roads": roads_table(HOURS), "first": first_table()})


def again() -> dict[str, Table]:
    return {"first": Table("road", COLUMNS, {name: tuple(residuals_on(ROADS[name], 1)) for name in SENTINELS})}


def explore(arguments: Sequence[str]) -> None:
    parser = argparse.ArgumentParser(
        prog="python -m docs.studies healthy_hours",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--hours", type=float, default=24.0, help="simulated, shared by the roads (default: 24)")
    show("healthy driving", roads_table(parser.parse_args(arguments).hours))


SENTINELS = ("vehicle on ice",)

STUDY = Study(
    "hours of healthy driving, and how near the monitors came to a fallback",
    measure,
    again,
    {"first": SENTINELS},
    explore=explore,
    seconds=300,
)

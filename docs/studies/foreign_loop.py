"""Recordings of a loop that is not ours, for identification: another integrator, other blocks, another logger.

Motor and car are blocks of their own, which are stepped one after the other every STEP, as co-simulation tools do: the
car gets a torque that is held. So torques act up to half a step earlier or later than they are recorded. The channels
are logged with delays of their own. Many cars are driven at once, one element of an array each.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import make_interp_spline

from driveline.harness.manoeuvres.prbs import shift_register
from toolground.csv_file import write_csv

STEP, PARTS = 1e-3, 2
"""Step of the loop in s, and steps of the integrator (Runge, Kutta) in it."""

LOGGED = 0.002
"""Between rows of the logger in s."""

SETTLED = 0.1
"""Time in s before the first row."""

SPEED = 15.0 / 3.6
"""In m/s, at the beginning."""

ORDERS = ("averaged", "motor first", "car first")
"""The car gets the mean of the motor torque over the step, that of its end, or that of its beginning."""


@dataclass(frozen=True)
class Car:
    """Motor side but for i, r, m: inertias in kg.m2, C in N.m/rad, phi_B in rad, tau in s."""

    J_2: float
    C: float
    phi_B: float
    J_1: float = 0.055
    tau: float = 0.003
    i: float = 9.0
    r: float = 0.29
    m: float = 1450.0

    @property
    def known(self) -> dict[str, float]:
        """What the vehicle file tells of it."""
        return {name: getattr(self, name) for name in ("J_1", "i", "r", "m")}


@dataclass(frozen=True)
class Loop:
    """How it is stepped and logged.

    Attributes:
        order: one of ORDERS.
        late_omega, late_T_mot, late_T_load: delays of the logger in s.
        amplitude, mean: of the demand in N.m.
        clock: time in s for which it stays at least.
        gain: of the measurement wheels.
    """

    order: str = ORDERS[0]
    late_omega: float = 0.0
    late_T_mot: float = 0.0
    late_T_load: float = 0.0
    amplitude: float = 30.0
    mean: float = 10.0
    clock: float = 0.04
    gain: float = 1.01

    @property
    def shifts(self) -> tuple[float, float]:
        """Time in s by which motor and load torque are recorded after the motor speed that they act on: that of the
        logger and of holding."""
        held = {"averaged": 0.0, "motor first": 0.5 * STEP, "car first": -0.5 * STEP}[self.order]
        return self.late_T_mot - self.late_omega + held, self.late_T_load - self.late_omega


def drawn(count: int, seed: int) -> tuple[list[Car], list[Loop]]:
    """Cars and loops at random: half without skew, half with up to 1 ms of each channel."""
    rng = np.random.default_rng(seed)

    def between(low: float, high: float) -> float:
        """Evenly on a logarithmic scale."""
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    cars = [
        Car(between(0.18, 0.65), between(70.0, 200.0), between(0.05, 0.25), between(0.04, 0.08), between(0.002, 0.004))
        for _ in range(count)
    ]
    loops = []
    for k in range(count):
        late = rng.uniform(0.0, 0.001, 3) * (k % 2)
        order = ORDERS[rng.integers(3)] if k % 2 else ORDERS[0]
        amplitude, clock = float(rng.choice([15.0, 30.0, 50.0])), float(rng.choice([0.03, 0.04, 0.05]))
        late_omega, late_T_mot, late_T_load = map(float, late)
        loops.append(
            Loop(order, late_omega, late_T_mot, late_T_load, amplitude, clock=clock, gain=float(rng.normal(1.0, 0.01)))
        )
    return cars, loops


def driven(cars: Sequence[Car], loops: Sequence[Loop], seeds: Sequence[int], duration: float = 10.0) -> np.ndarray:
    """The demand, the motor torque, and at the same times omega_1, omega_2 and T_load of each car, shape
    (steps + 1, 5, cars), STEP/PARTS apart."""
    J_1, J_2, C, phi_B, tau, i, r, m = (
        np.array([getattr(car, name) for car in cars]) for name in ("J_1", "J_2", "C", "phi_B", "tau", "i", "r", "m")
    )
    steps = round((SETTLED + duration) / STEP) + 10
    demand = np.array([_demand(loop, steps, seed) for loop, seed in zip(loops, seeds, strict=True)]).T
    T_mot = _answer(demand, tau)
    acting = np.empty((steps, len(cars)))
    for k, loop in enumerate(loops):
        first, last = T_mot[:-1:PARTS, k], T_mot[PARTS::PARTS, k]
        mean = (first + 4.0 * T_mot[1::PARTS, k] + last) / 6.0
        acting[:, k] = {"averaged": mean, "motor first": last, "car first": first}[loop.order]
    c_slip, sigma_s, d_low, v_low, g = 140_000.0, 0.05, 4000.0, 0.5, 9.81

    def force(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        slip = r * x[1] / i - x[3]
        return c_slip / sigma_s * x[4] + d_low * slip / (1.0 + (x[3] / v_low) ** 2), slip

    def derivative(x: np.ndarray, T: np.ndarray) -> np.ndarray:
        F, slip = force(x)
        T_gear = C * (x[2] - np.clip(x[2], -phi_B, phi_B))
        resists = m * g * 0.012 * np.tanh(x[3] / 0.1) + 0.42 * x[3] * abs(x[3])
        relaxes = np.maximum(abs(r * x[1] / i), abs(x[3])) / sigma_s
        return np.array(
            [(T - T_gear) / J_1, (T_gear - r * F / i) / J_2, x[0] - x[1], (F - resists) / m, slip - relaxes * x[4]]
        )

    omega = np.full(len(cars), SPEED) / r * i
    x = np.array([omega, omega, phi_B + T_mot[0] / C, omega * r / i, 0.0 * omega])
    h, out = STEP / PARTS, np.empty((steps * PARTS + 1, 5, len(cars)))
    out[0] = demand[0], T_mot[0], x[0], x[1], -r * force(x)[0] / i
    for k in range(steps * PARTS):
        T = acting[k // PARTS]
        a = derivative(x, T)
        b = derivative(x + 0.5 * h * a, T)
        c = derivative(x + 0.5 * h * b, T)
        d = derivative(x + h * c, T)
        x = x + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        out[k + 1] = demand[k // PARTS], T_mot[k + 1], x[0], x[1], -r * force(x)[0] / i
    return out


def _demand(loop: Loop, steps: int, seed: int) -> np.ndarray:
    bits = np.roll(np.array(shift_register(511), dtype=float), np.random.default_rng(seed).integers(511))
    # whole numbers of the loop's clock: the demand changes in the row that is logged
    number = np.arange(steps) // round(loop.clock / STEP)
    return loop.mean + loop.amplitude * (2.0 * bits[number % 511] - 1.0)


def _answer(demand: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """Of motor control (paper, eq. (1)), STEP/PARTS apart: the exact solution for a demand that is held."""
    h, rate = STEP / PARTS, 1.0 / (np.sqrt(2.0) * tau)
    e, c, s = np.exp(-rate * h), np.cos(rate * h), np.sin(rate * h)
    T, slope = demand[0], 0.0 * demand[0]
    out = [T]
    for held in np.repeat(demand, PARTS, axis=0):
        off = T - held
        turn = slope / rate + off
        T, slope = held + e * (off * c + turn * s), e * rate * (turn * c - off * s - off * c - turn * s)
        out.append(T)
    return np.array(out)


def logged(true: np.ndarray, car: Car, loop: Loop, seed: int, path: Path, duration: float = 10.0) -> None:
    """Writes the recording of a drive: motor speed to .15 rad/s and rounded, torque to .3 N.m, both measurement wheels
    to 10 N.m with an offset and a gain, wheel speed by messages every 20 ms.

    Args:
        true: of this car from `driven`, shape (steps + 1, 5).
    """
    rng, times = np.random.default_rng([seed, 1]), np.arange(len(true)) * STEP / PARTS
    rows = SETTLED + np.arange(0.0, duration - 0.5 * LOGGED, LOGGED)
    n, messages = len(rows), np.floor(rows / 0.02 + 1e-9) * 0.02 - 0.02
    demand, T_mot, omega_1, omega_2, T_load = true.T

    def late(signal: np.ndarray, by: float) -> np.ndarray:
        return make_interp_spline(times, signal, k=3)(rows - by)

    noisy = late(omega_1, loop.late_omega) + 0.15 * rng.standard_normal(n)
    columns = {
        "time [s]": rows,
        "omega_1 [rad/s]": np.round(noisy / 0.1) * 0.1,
        "T_mot [N.m]": late(T_mot, loop.late_T_mot) + 0.3 * rng.standard_normal(n),
        "T_ref [N.m]": demand[np.round(rows / STEP * PARTS).astype(int)],
        "omega_wheel [rad/s]": np.round(np.interp(messages, times, omega_2) / car.i, 2),
        "T_wheel [N.m]": loop.gain * -car.i * late(T_load, loop.late_T_load) + 8.0 + 10.0 * rng.standard_normal(n),
    }
    table = np.empty(n, dtype=[(heading, float) for heading in columns])
    for heading, values in columns.items():
        table[heading] = np.round(values, 6)
    write_csv(table, path)

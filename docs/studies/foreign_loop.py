"""Recordings of a loop that is not ours, for identification: another integrator, other blocks, another logger.

Motor, drive train and vehicle are blocks of their own, which are stepped one after the other every STEP and hold what
they get from each other meanwhile, as co-simulation tools do. So torques act up to half a step earlier or later than
they are recorded. Nothing of the estimator's model is used.
"""

from dataclasses import dataclass
from math import cos, exp, sin, sqrt, tanh
from pathlib import Path

import numpy as np

from driveline.harness.base.csv_file import write_csv

FINE = 1e-4
"""Step of the integrator (Runge, Kutta) in s; delays are multiples of it."""

STEP = 10
"""Fine steps in a step of the loop, of 1 ms."""

CLOCK = 0.04
"""Time in s for which the demand stays at least."""


@dataclass(frozen=True)
class Car:
    """Motor side but for r, m: inertias in kg.m2, C in N.m/rad, phi_B in rad, tau in s; tyre c_t in N.m/rad and d_t in
    N.m.s/rad, in series: a spring above c_t/d_t rad/s, a damper below."""

    J_1: float
    J_2: float
    C: float
    phi_B: float
    tau: float
    i: float
    r: float
    m: float
    c_t: float
    d_t: float

    @property
    def known(self) -> dict[str, float]:
        """What the vehicle file tells of it."""
        return {name: getattr(self, name) for name in ("J_1", "i", "r", "m")}


CARS = (
    Car(J_1=0.055, J_2=0.42, C=96.0, phi_B=0.11, tau=0.0036, i=9.0, r=0.29, m=1450.0, c_t=610.0, d_t=34.0),
    Car(J_1=0.09, J_2=0.24, C=231.0, phi_B=0.07, tau=0.0024, i=10.5, r=0.34, m=2200.0, c_t=2400.0, d_t=30.0),
    Car(J_1=0.04, J_2=0.3, C=71.0, phi_B=0.21, tau=0.0031, i=8.0, r=0.28, m=1000.0, c_t=420.0, d_t=25.0),
)


@dataclass(frozen=True)
class Loop:
    """How it is stepped and logged.

    Attributes:
        order: "motor first", "plant first" (Gauss, Seidel: the drive train gets the motor torque at the end or at the
            beginning of the step) or "averaged" (its mean over the step).
        load_held: whether the load torque is held too: the vehicle is stepped after the drive train.
        T_s: between samples of the logger in s.
        late_omega, late_T_mot, late_T_load: delays of the logger in s.
        mean, amplitude: of the demand in N.m.
        duration: in s.
    """

    order: str = "motor first"
    load_held: bool = False
    T_s: float = 0.002
    late_omega: float = 0.0
    late_T_mot: float = 0.0
    late_T_load: float = 0.0
    mean: float = 10.0
    amplitude: float = 30.0
    duration: float = 10.0

    @property
    def shifts(self) -> tuple[float, float]:
        """Time in s by which recorded motor and load torque are behind the motor speed that they act on: that of the
        logger and of holding."""
        half = 0.5 * STEP * FINE
        held = {"motor first": half, "plant first": -half, "averaged": 0.0}[self.order]
        late_load = self.late_T_load - self.late_omega - (half if self.load_held else 0.0)
        return self.late_T_mot - self.late_omega + held, late_load


def driven(car: Car, loop: Loop, seed: int) -> dict[str, np.ndarray]:
    """Signals every FINE seconds, before the logger."""
    rng = np.random.default_rng(seed)
    bits = rng.integers(0, 2, int(loop.duration / CLOCK) + 2)
    demand = loop.mean + loop.amplitude * (2.0 * bits - 1.0)
    steps, clock = round(loop.duration / FINE) // STEP + 20, round(CLOCK / FINE)
    J_v = car.m * car.r**2 / car.i**2
    omega = 9.0 * 15.0 / 3.6 / car.r
    x = [omega, omega, car.phi_B + loop.mean / car.C, omega, loop.mean / car.c_t]
    T, rate, T_load = float(demand[0]), 0.0, -loop.mean
    out = np.empty((steps * STEP, 5))
    for k in range(steps):
        T_ref = float(demand[min(k * STEP // clock, len(demand) - 1)])
        before, torques = T, []
        for _ in range(STEP):
            T, rate = _lag(T, rate, T_ref, car.tau)
            torques.append(T)
        acting = {"motor first": T, "plant first": before, "averaged": (sum(torques) + 0.5 * (before - T)) / STEP}
        held = T_load if loop.load_held else None
        for j in range(STEP):
            x = _runge_kutta(x, acting[loop.order], held, car, loop.mean, J_v)
            T_load = -car.c_t * x[4]
            out[k * STEP + j] = x[0], x[1], torques[j], T_ref, T_load
    return dict(zip(("omega_1", "omega_2", "T_mot", "T_ref", "T_load"), out.T, strict=True))


def _lag(T: float, rate: float, T_ref: float, tau: float) -> tuple[float, float]:
    """Motor control after FINE seconds of a demand that is held: the exact solution."""
    a = 1.0 / (sqrt(2.0) * tau)
    e, c, s = exp(-a * FINE), cos(a * FINE), sin(a * FINE)
    off, slope = T - T_ref, (rate + a * (T - T_ref)) / a
    return T_ref + e * (off * c + slope * s), e * a * (slope * c - off * s - off * c - slope * s)


def _derivative(
    x: list[float], T_mot: float, T_load: float | None, car: Car, resisting: float, J_v: float
) -> list[float]:
    """Of motor and wheel speed, twist, vehicle speed and deflection of the tyre, motor side."""
    omega_1, omega_2, phi, v, u = x
    y = phi - car.phi_B if phi > car.phi_B else phi + car.phi_B if phi < -car.phi_B else 0.0
    T_gear, tyre = car.C * y, car.c_t * u
    load = -tyre if T_load is None else T_load
    drag = resisting * tanh(v)
    return [
        (T_mot - T_gear) / car.J_1,
        (T_gear + load) / car.J_2,
        omega_1 - omega_2,
        (tyre - drag) / J_v,
        omega_2 - v - tyre / car.d_t,
    ]


def _runge_kutta(
    x: list[float], T_mot: float, T_load: float | None, car: Car, resisting: float, J_v: float
) -> list[float]:
    def at(other: list[float], by: float) -> list[float]:
        there = [a + by * FINE * b for a, b in zip(x, other, strict=True)]
        return _derivative(there, T_mot, T_load, car, resisting, J_v)

    a = _derivative(x, T_mot, T_load, car, resisting, J_v)
    b = at(a, 0.5)
    c = at(b, 0.5)
    d = at(c, 1.0)
    return [x0 + FINE / 6.0 * (p + 2.0 * q + 2.0 * r + s) for x0, p, q, r, s in zip(x, a, b, c, d, strict=True)]


def logged(car: Car, loop: Loop, seed: int, path: Path) -> None:
    """Writes the recording of a drive: motor speed to .15 rad/s and rounded, torque to .3 N.m, both measurement wheels
    to 10 N.m per 2 ms with an offset and 1 % too much, wheel speed by messages every 20 ms."""
    true, rng = driven(car, loop, seed), np.random.default_rng([seed, 1])
    every, first = round(loop.T_s / FINE), 10 * STEP
    ticks = np.arange(first, first + round(loop.duration / FINE), every)
    n = len(ticks)

    def late(name: str, by: float) -> np.ndarray:
        return true[name][ticks - 1 - round(by / FINE)]  # row k is the end of fine step k

    T_wheel = -car.i * late("T_load", loop.late_T_load)
    noise = 10.0 * sqrt(0.002 / loop.T_s)
    message = (ticks // 200) * 200 - 1
    columns = {
        "time [s]": (ticks - first) * FINE,
        "omega_1 [rad/s]": np.round((late("omega_1", loop.late_omega) + 0.15 * rng.standard_normal(n)) / 0.1) * 0.1,
        "T_mot [N.m]": late("T_mot", loop.late_T_mot) + 0.3 * rng.standard_normal(n),
        "T_ref [N.m]": true["T_ref"][ticks],
        "omega_wheel [rad/s]": np.round(true["omega_2"][message] / car.i, 2),
        "T_wheel [N.m]": 1.01 * T_wheel + 8.0 + noise * rng.standard_normal(n),
    }
    rows = np.empty(n, dtype=[(heading, float) for heading in columns])
    for heading, values in columns.items():
        rows[heading] = np.round(values, 6)
    write_csv(rows, path)

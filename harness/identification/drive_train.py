"""The model that is identified: the two inertias of the paper's eq. (2), with structural damping.

    J_1 domega_1/dt = T_mot - T_gear
    J_2 domega_2/dt = T_load + T_gear
           dphi/dt  = omega_1 - omega_2          T_gear = C y + s d dphi/dt,   y = b(phi, phi_B)

The damper acts between teeth that touch: s = min(1, |y|/Y_D), so that the torque has no jump.
"""

from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple

import casadi as ca

Y_D = 0.01
"""Twist in rad (motor side) beyond the flank from which on the damper acts in full."""

STEPS = 4
"""Of the integrator in a sample. At 2 ms and 8 Hz its frequency is 1e-5 too high."""


class Parameters(NamedTuple):
    """Of the drive train and of its recorded torques, motor side.

    Attributes:
        J_1, J_2: inertia of motor and wheels in kg.m2.
        C: stiffness in N.m/rad.
        d: structural damping in N.m.s/rad.
        phi_B: half the backlash in rad.
        g_T, g_L: recorded over true motor and load torque.
        late_1, late_T, late_L: time in s by which motor speed, motor and load torque are recorded late; what is common
            to all cannot be seen. See `harness.identification.time_shifts`.
    """

    J_1: float
    J_2: float
    C: float
    d: float
    phi_B: float
    g_T: float = 1.0
    g_L: float = 1.0
    late_1: float = 0.0
    late_T: float = 0.0
    late_L: float = 0.0

    @property
    def shifts(self) -> tuple[float, float]:
        """Time in s by which motor and load torque are recorded after the motor speed."""
        return self.late_T - self.late_1, self.late_L - self.late_1


DAMPING = 0.1
"""Damping ratio that a drive train is expected to have."""

DELAYS = ("late_1", "late_T", "late_L")
"""Of the parameters those of the logger."""


def damping(p: Parameters) -> float:
    """d in N.m.s/rad with that ratio."""
    return 2.0 * DAMPING * sqrt(p.C * p.J_1 * p.J_2 / (p.J_1 + p.J_2))


class State(NamedTuple):
    """Attributes:
    omega_1, omega_2: speed of motor and wheels in rad/s.
    phi: twist in rad.
    o_T, o_L: true less recorded motor and load torque, without their gain, in N.m.
    """

    omega_1: ca.SX
    omega_2: ca.SX
    phi: ca.SX
    o_T: ca.SX
    o_L: ca.SX


def gear_torque(phi: ca.SX, dphi: ca.SX, p: Parameters, implicit: ca.SX | float = 0.0) -> ca.SX:
    """Torque in N.m of spring and damper.

    Args:
        phi: twist in rad.
        dphi: its rate in rad/s; less implicit times the torque, if that depends on it.
    """
    y = phi - ca.fmax(-p.phi_B, ca.fmin(phi, p.phi_B))
    d = p.d * ca.fmin(1.0, ca.fabs(y) / Y_D)
    return (p.C * y + d * dphi) / (1.0 + d * implicit)


def step(x: State, T_mot: ca.SX, T_load: ca.SX, h: ca.SX, p: Parameters) -> State:
    """The state h seconds later: half a step of the twist, a step of the speeds, half a step of the twist
    (Verlet, of second order; the damper with the mean of both speeds).

    Args:
        T_mot, T_load: recorded torques in N.m, means of the step.
    """
    T_1, T_2 = T_mot / p.g_T + x.o_T, T_load / p.g_L + x.o_L
    phi = x.phi + 0.5 * h * (x.omega_1 - x.omega_2)
    free = x.omega_1 - x.omega_2 + 0.5 * h * (T_1 / p.J_1 - T_2 / p.J_2)
    T_gear = gear_torque(phi, free, p, implicit=0.5 * h * (1.0 / p.J_1 + 1.0 / p.J_2))
    omega_1 = x.omega_1 + h * (T_1 - T_gear) / p.J_1
    omega_2 = x.omega_2 + h * (T_2 + T_gear) / p.J_2
    return State(omega_1, omega_2, phi + 0.5 * h * (omega_1 - omega_2), x.o_T, x.o_L)


def d_torques_by(names: Sequence[str], d_acting: ca.SX) -> ca.SX:
    """Derivatives of the torques of a sample by parameters, shape (2 STEPS, names): each depends on its own shift.

    Args:
        d_acting: by these, shape (2 STEPS,).
    """
    d = ca.SX(2 * STEPS, len(names))
    both = (("late_1", slice(None), -1.0), ("late_T", slice(0, STEPS), 1.0), ("late_L", slice(STEPS, None), 1.0))
    for name, at, sign in both:
        if name in names:
            d[at, names.index(name)] = sign * d_acting[at]
    return d


def sample(x: State, T_mot: Sequence[ca.SX], T_load: Sequence[ca.SX], T_s: ca.SX, p: Parameters) -> State:
    """The state after a sample of T_s seconds.

    Args:
        T_mot, T_load: recorded torques in N.m, means of each of STEPS parts of the sample.
    """
    for T_1, T_2 in zip(T_mot, T_load, strict=True):
        x = step(x, T_1, T_2, T_s / STEPS, p)
    return x

"""The model that is identified: the two inertias of the paper's eq. (2), with structural damping, on a rolling tyre.

    J_1 domega_1/dt = T_mot - T_gear
    J_2 domega_2/dt = T_gear - T_tyre
           dphi/dt  = omega_1 - omega_2          T_gear = C y + s d dphi/dt,   y = b(phi, phi_B)
    J_v domega_v/dt = T_tyre + R
          dT_c/dt   = c_t (omega_2 - omega_v) - max(|omega_2|, |omega_v|) T_c/sigma_t
            T_tyre  = T_c + d_low (omega_2 - omega_v)/(1 + (omega_v/omega_low)^2)

The damper acts between teeth that touch: s = min(1, |y|/Y_D), so that the torque has no jump. The tyre is that of both
plants, on the motor side. R, what resists the vehicle, changes slowly.
"""

from math import sqrt
from typing import NamedTuple

import casadi as ca

Y_D = 0.01
"""Twist in rad (motor side) beyond the flank from which on the damper acts in full."""

EDGE = 1e-3
"""Twist in rad (motor side) over which the teeth come into contact. An edge without width makes the filter jump with
the parameters, so that nothing could be differentiated; .1 mrad at the wheel is below what any gear holds."""

STEPS = 4
"""Of the integrator in a sample. At 2 ms and 8 Hz its frequency is 1e-5 too high."""

DAMPING = 0.1
"""Damping ratio that a drive train is expected to have."""

DELAYS = ("late_T", "late_L")
"""Of the parameters those of the logger."""


class Parameters(NamedTuple):
    """Of the drive train, of its recorded torques and of what the model lacks, motor side.

    Attributes:
        J_1, J_2: inertia of motor and wheels in kg.m2.
        C: stiffness in N.m/rad.
        d: structural damping in N.m.s/rad.
        phi_B: half the backlash in rad.
        g_T, g_L: recorded over true motor and load torque.
        late_T, late_L: time in s by which motor and load torque are recorded after the motor speed. What is common to
            all channels cannot be seen.
        c_t: stiffness of the tyre in N.m/rad; 0: J_2 carries the vehicle.
        sigma_t: its relaxation length in rad.
        lack_1, lack_phi, lack_L: standard deviation of what the equations of motor speed, twist and tyre lack in a
            sample, in rad/s, rad and N.m.
    """

    J_1: float
    J_2: float
    C: float
    d: float
    phi_B: float
    g_T: float = 1.0
    g_L: float = 1.0
    late_T: float = 0.0
    late_L: float = 0.0
    c_t: float = 1000.0
    sigma_t: float = 5.0
    lack_1: float = 1e-3
    lack_phi: float = 1e-5
    lack_L: float = 0.01

    @property
    def damping(self) -> float:
        """d in N.m.s/rad with DAMPING."""
        return 2.0 * DAMPING * sqrt(self.C * self.J_1 * self.J_2 / (self.J_1 + self.J_2))


class Vehicle(NamedTuple):
    """What is known of it, motor side.

    Attributes:
        J_v: its inertia in kg.m2, m r^2/i^2.
        d_low: damping of the tyre at standstill in N.m.s/rad.
        omega_low: speed in rad/s at which that has halved.
    """

    J_v: float
    d_low: float = 0.0
    omega_low: float = 1.0


class State(NamedTuple):
    """Attributes:
    omega_1, omega_2, omega_v: speed of motor, wheels and vehicle in rad/s.
    phi: twist in rad.
    T_c: torque of the tyre's carcass in N.m.
    R: torque on the vehicle in N.m.
    o_T: true less recorded motor torque, without its gain, in N.m.
    o_L: recorded less true load torque in N.m.
    """

    omega_1: ca.SX
    omega_2: ca.SX
    omega_v: ca.SX
    phi: ca.SX
    T_c: ca.SX
    R: ca.SX
    o_T: ca.SX
    o_L: ca.SX


def gear_torque(phi: ca.SX, dphi: ca.SX, p: Parameters, implicit: ca.SX | float = 0.0) -> ca.SX:
    """Torque in N.m of spring and damper.

    Args:
        phi: twist in rad.
        dphi: its rate in rad/s; less implicit times the torque, if that depends on it.
    """
    driving, braking = phi - p.phi_B, phi + p.phi_B
    y = 0.5 * (driving + braking + ca.sqrt(driving**2 + EDGE**2) - ca.sqrt(braking**2 + EDGE**2))
    d = p.d * ca.fmin(1.0, ca.fabs(y) / Y_D)
    return (p.C * y + d * dphi) / (1.0 + d * implicit)


def tyre_torque(x: State, behind: Vehicle) -> ca.SX:
    """In N.m; the load torque is its opposite."""
    return x.T_c + behind.d_low * (x.omega_2 - x.omega_v) / (1.0 + (x.omega_v / behind.omega_low) ** 2)


def relaxation(x: State, p: Parameters) -> ca.SX:
    """Of the carcass, in 1/s."""
    return ca.fmax(ca.fabs(x.omega_2), ca.fabs(x.omega_v)) / p.sigma_t


def derivative(x: State, T_mot: ca.SX, p: Parameters, behind: Vehicle) -> State:
    """Of the state by time; T_mot is the recorded torque in N.m."""
    T_gear, T_tyre = gear_torque(x.phi, x.omega_1 - x.omega_2, p), tyre_torque(x, behind)
    nothing = ca.SX(0)
    return State(
        omega_1=(T_mot / p.g_T + x.o_T - T_gear) / p.J_1,
        omega_2=(T_gear - T_tyre) / p.J_2,
        omega_v=(T_tyre + x.R) / behind.J_v,
        phi=x.omega_1 - x.omega_2,
        T_c=p.c_t * (x.omega_2 - x.omega_v) - relaxation(x, p) * x.T_c,
        R=nothing,
        o_T=nothing,
        o_L=nothing,
    )


def step(x: State, T_mot: ca.SX, h: ca.SX, p: Parameters, behind: Vehicle) -> State:
    """The state h seconds later: half a step of twist and carcass, a step of the speeds, half a step of both again
    (Verlet, of second order; the damper with the mean of both speeds).

    Args:
        T_mot: recorded torque in N.m, mean of the step.
    """
    T_1 = T_mot / p.g_T + x.o_T
    stretch = x.T_c + 0.5 * h * p.c_t * (x.omega_2 - x.omega_v)
    x = x._replace(phi=x.phi + 0.5 * h * (x.omega_1 - x.omega_2), T_c=stretch / (1.0 + 0.5 * h * relaxation(x, p)))
    T_tyre = tyre_torque(x, behind)
    free = x.omega_1 - x.omega_2 + 0.5 * h * (T_1 / p.J_1 + T_tyre / p.J_2)
    T_gear = gear_torque(x.phi, free, p, implicit=0.5 * h * (1.0 / p.J_1 + 1.0 / p.J_2))
    x = x._replace(
        omega_1=x.omega_1 + h * (T_1 - T_gear) / p.J_1,
        omega_2=x.omega_2 + h * (T_gear - T_tyre) / p.J_2,
        omega_v=x.omega_v + h * (T_tyre + x.R) / behind.J_v,
    )
    stretching = p.c_t * (x.omega_2 - x.omega_v) - relaxation(x, p) * x.T_c
    return x._replace(phi=x.phi + 0.5 * h * (x.omega_1 - x.omega_2), T_c=x.T_c + 0.5 * h * stretching)


def sample(x: State, T_mot: ca.SX, T_s: ca.SX, p: Parameters, behind: Vehicle) -> State:
    """The state after a sample of T_s seconds.

    Args:
        T_mot: recorded torque in N.m, means of each of STEPS parts of the sample.
    """
    for torque in ca.vertsplit(T_mot):
        x = step(x, torque, T_s / STEPS, p, behind)
    return x


def recorded_load(x: State, T_mot: ca.SX, p: Parameters, behind: Vehicle) -> ca.SX:
    """The load torque in N.m as a sensor records it that is late: a Taylor series of the true one. Shifting the
    recording instead would smooth its noise between samples, and so favour delays of half a sample."""
    z = State._make(ca.vertsplit(ca.SX.sym("z", len(State._fields))))
    at, rate = ca.vertcat(*z), ca.vertcat(*derivative(z, T_mot, p, behind))
    T = tyre_torque(z, behind)
    dT = ca.jtimes(T, at, rate)
    ddT = ca.jtimes(dT, at, rate)
    late = z.o_L - p.g_L * (T - p.late_L * dT + 0.5 * p.late_L**2 * ddT)
    return ca.substitute(late, at, ca.vertcat(*x))

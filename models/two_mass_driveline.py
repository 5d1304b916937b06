"""Two inertias joined by an elastic gear with backlash, and a vehicle on a tyre (paper, eq. (2)).

    J_1 domega_1/dt = T_mot - T_gear
    J_2 domega_2/dt = T_load + T_gear
           dphi/dt  = omega_1 - omega_2          T_gear = C b(phi, phi_B)

Everything is referred to the motor shaft. The vehicle acts through the load torque of a linear tyre
with relaxation and of the brakes; w = omega_2/i is the speed of the wheels:

    T_load  = -(r F + T_brake q)/i               v_s = r w - v
    F       = c_slip/sigma_s u + d_low v_s/(1 + (v/v_low)^2)
    du/dt   = v_s - max(|r w|, |v|) u/sigma_s
    m dv/dt = F - m g (c_rr tanh(v/v_rr) + sin(slope)) - c_wa v |v|

The relaxation of the tyre stays regular at standstill (J. E. Bernard, C. L. Clover, "Tire modeling for
low-speed and high-speed calculations", SAE 950311, 1995).

With `recorded_load` vehicle and tyre are left out and T_load_rec takes the place of T_load; what
they would show then follows omega_2 without slip.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Boolean, Real
from fmublocks.block.operators import maximum, sign, where
from fmublocks.block.types import ContinuousBlock

from .physics import brake, vehicle
from .physics.backlash import dead_zone
from .physics.brake import BRAKE
from .physics.plant import Input, Output
from .physics.vehicle import CAR


class Parameters(NamedTuple):
    J_1: vehicle.MotorInertia = CAR.J_1
    J_2: vehicle.WheelInertia = CAR.J_2
    C: vehicle.Stiffness = CAR.C
    phi_B: vehicle.HalfGap = CAR.phi_B
    i: vehicle.GearRatio = CAR.i
    m: vehicle.Mass = CAR.m
    r: vehicle.WheelRadius = CAR.r
    c_slip: vehicle.SlipStiffness = CAR.c_slip
    sigma_s: Annotated[float, Real("m", "relaxation length of the linear tyre", 0.02, 1.0)] = 0.05
    d_low: vehicle.LowSpeedDamping = CAR.d_low
    v_low: vehicle.LowSpeed = CAR.v_low
    c_rr: vehicle.RollingResistance = CAR.c_rr
    v_rr: vehicle.RollingSpeed = CAR.v_rr
    c_wa: vehicle.AirDrag = CAR.c_wa
    g: vehicle.Gravity = CAR.g
    z_br: brake.BristleDeflection = BRAKE.z_br
    t_br: brake.BristleDamping = BRAKE.t_br
    omega_sat: brake.BristleSpeedLimit = BRAKE.omega_sat
    v_0: vehicle.StartSpeed = 0.0
    T_0: vehicle.StartTorque = 0.0
    recorded_load: Annotated[bool, Boolean("leave the vehicle out and take T_load_rec as load torque")] = False


class State(NamedTuple):
    omega_1: Annotated[float, Real("rad/s", "speed of the motor")]
    omega_2: Annotated[float, Real("rad/s", "speed of the wheels, motor side")]
    phi: Annotated[float, Real("rad", "twist of the drive train, motor side")]
    v: Annotated[float, Real("m/s", "speed of the vehicle")]
    u: Annotated[float, Real("m", "longitudinal deflection of the tyre", nominal=0.001)]
    z: Annotated[float, Real("rad", "twist of the brake bristles, wheel side", nominal=0.005)]


def start(u: Input, p: Parameters) -> State:
    """Standstill, or stationary rolling at v_0 with the motor torque T_0 on a level road."""
    v, T_0, i, r = p.v_0, p.T_0, p.i, p.r
    rolling = v > 0.0
    resisting = p.m * p.g * p.c_rr + p.c_wa * v * v
    a = (i * T_0 / r - resisting) / (p.m + (p.J_1 + p.J_2) * i * i / (r * r))
    T_gear = where(p.recorded_load, T_0, T_0 - p.J_1 * i * a / r)
    slip = where(p.recorded_load, 0.0, i * (T_gear - p.J_2 * i * a / r) / r / p.c_slip)
    omega_2 = i * v * (1.0 + slip) / r
    twist = T_gear / p.C + sign(T_gear) * p.phi_B
    return State(
        omega_1=where(rolling, omega_2, 0.0),
        omega_2=where(rolling, omega_2, 0.0),
        phi=where(rolling, twist, 0.0),
        v=v,
        u=where(rolling, p.sigma_s * slip, 0.0),
        z=where(rolling, p.z_br, 0.0),
    )


def gear_torque(x: State, p: Parameters) -> float:
    return p.C * dead_zone(x.phi, p.phi_B)


def tyre_force(x: State, p: Parameters) -> float:
    """Force in N of the tyre on the vehicle."""
    v_s = p.r / p.i * x.omega_2 - x.v
    return p.c_slip / p.sigma_s * x.u + vehicle.standstill_damping(x.v, p) * v_s


def load_torque(x: State, u: Input, F: float, dz: float, p: Parameters) -> float:
    """Torque in N.m (motor side) of tyre force F (N) and brake, or the recorded one."""
    T_br = u.T_brake * brake.grip(x.z, dz, p)
    return where(p.recorded_load, u.T_load_rec, -1.0 / p.i * (p.r * F + T_br))


def derivative(x: State, u: Input, p: Parameters) -> State:
    w = 1.0 / p.i * x.omega_2
    F = tyre_force(x, p)
    dz = brake.bristle_rate(w, x.z, p)
    T_load = load_torque(x, u, F, dz, p)
    T_gear = gear_torque(x, p)
    return State(
        omega_1=1.0 / p.J_1 * (u.T_mot - T_gear),
        omega_2=1.0 / p.J_2 * (T_load + T_gear),
        phi=x.omega_1 - x.omega_2,
        v=1.0 / p.m * (F - vehicle.resistance(x.v, u.slope, p.m * p.g, p)),
        u=p.r * w - x.v - 1.0 / p.sigma_s * maximum(abs(p.r * w), abs(x.v)) * x.u,
        z=dz,
    )


def output(x: State, u: Input, p: Parameters) -> Output:
    dx = derivative(x, u, p)
    w = 1.0 / p.i * x.omega_2
    F = tyre_force(x, p)
    return Output(
        omega_1=x.omega_1,
        omega_2=x.omega_2,
        omega_wheel_L=w,
        omega_wheel_R=w,
        T_gear=gear_torque(x, p),
        T_load=load_torque(x, u, F, dx.z, p),
        T_rim=where(p.recorded_load, -p.i * u.T_load_rec, p.r * F),
        phi=x.phi,
        v=where(p.recorded_load, p.r * w, x.v),
        a_body=where(p.recorded_load, p.r / p.i * dx.omega_2, dx.v),
        pitch=0.0,
    )


def event_indicators(x: State, u: Input, p: Parameters) -> tuple[float, ...]:
    """Both flanks of the gap; wheels at rest (the bristles turn round); the kinks of the tyre's rate."""
    return (x.phi - p.phi_B, x.phi + p.phi_B, x.omega_2, p.r / p.i * x.omega_2 - x.v, x.v)


BLOCK = ContinuousBlock(
    name="TwoMassDriveline",
    description="Design model: two inertias, elastic gear with backlash, vehicle on a linear tyre",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=Output,
    start=start,
    output=output,
    derivative=derivative,
    event_indicators=event_indicators,
    step_size=0.001,
)

"""Detailed vehicle to validate the controller on: twenty states, every effect with its own element.

Beyond the design model: backlash with impact damping in the gear stage, torque ripple and friction
of the motor, a powertrain block on mounts that takes the reaction torques, an open differential
with unequal half shafts, two nonlinear tyres with load transfer, hubs on a fore-aft bushing and a
pitching body. Wheel side except omega_1 and theta_1 (the paper: 'a more complex model ... which
includes several additional real world effects').

    gear stage   dgamma/dt = omega_1/i + omega_p - omega_g,   y = b(gamma, phi_B/i)
                 T_g = k_g y + d_g dgamma/dt min(1, |y|/y_g), never pulling (T_g y >= 0)
    rotor        J_1 (domega_1/dt + domega_p/dt) = T_a - T_g/i
    mounts       J_p domega_p/dt = -T_a - (1 - 1/i) T_g - T_h
    carrier      J_g domega_g/dt = T_g - T_L - T_R - c_fg tanh(omega_g/omega_fg) - v_fg omega_g
    side gears   J_d domega_d/dt = T_R - T_L - d_d omega_d
    wheel k      J_w/2 domega_k/dt = T_k - r F_k - T_r,k - T_br,k
    hubs         m_h dv_h/dt = F_L + F_R - F_h
    body         (m - m_h) dv/dt = F_h - resistance,   J_y domega_b/dt = F_h (h - r) - T_h - T_br - ...

T_a is the air-gap torque with friction and with ripple, but for what turns faster than 10 krad/s; T_h
is the mount torque, F_h the bushing force; F_k is half an axle's Magic Formula without curvature term on
the deflection u_k of the tyre (H. B. Pacejka, "Tire and Vehicle Dynamics", 3rd ed., 2012, section 4.3) with the
damping of a standing car, together no more than mu F_z/2.
The impact damping of the teeth grows with their penetration, so that the torque does not jump at the
contact (K. H. Hunt, F. R. E. Crossley, "Coefficient of restitution interpreted as damping in vibroimpact",
J. Applied Mechanics 42(2), 1975).
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real
from fmublocks.block.operators import atan, clip, cos, maximum, minimum, sign, sin, tanh, where
from fmublocks.block.types import ContinuousBlock

from .physics import brake, vehicle
from .physics.backlash import dead_zone
from .physics.brake import BRAKE
from .physics.plant import Input, Output
from .physics.vehicle import CAR

RIPPLE_FULL, RIPPLE_NONE = 5000.0, 10000.0
"""Rates in rad/s between which a ripple fades out.

A faster one would take steps of its own and moves nothing: at 5 krad/s about .001 of its torque comes to the gear
stage, k_g/(i^2 J_1 rate^2), and above less. In steps that do not resolve it, it would stand for a torque that is not
there.
"""


ALLOWED_ERROR = 1.0
"""Of a step of the integration, in units of what is tolerated: a hundred times the usual.

With ripple of up to 5 krad/s the estimate for steps of 1 ms comes near to it; T_gear is off by less than 1e-3 N.m then.
`python -m benchmarks.step_error` measures it in every manoeuvre.
"""


class Parameters(NamedTuple):
    J_1: vehicle.MotorInertia = CAR.J_1
    phi_B: vehicle.HalfGap = CAR.phi_B
    i: vehicle.GearRatio = CAR.i
    m: vehicle.Mass = CAR.m
    r: vehicle.WheelRadius = CAR.r
    J_w: Annotated[float, Real("kg.m2", "inertia of both driven wheels", 0.05, 200.0)] = 1.8
    k_s: Annotated[float, Real("N.m/rad", "stiffness of both half shafts together", 1e3, 5e6)] = 25800.0
    d_s: Annotated[float, Real("N.m.s/rad", "damping of both half shafts together", 0.0, 2000.0)] = 20.0
    asym: Annotated[float, Real("1", "asymmetry of the half shafts", -0.5, 0.5)] = 0.1
    J_g: Annotated[float, Real("kg.m2", "inertia of the differential carrier", 0.005, 20.0)] = 0.10
    k_g: Annotated[float, Real("N.m/rad", "stiffness of the gear stage", 1e4, 1e7)] = 120000.0
    d_g: Annotated[float, Real("N.m.s/rad", "impact damping of the gear stage", 0.0, 500.0)] = 12.0
    y_g: Annotated[float, Real("rad", "penetration at which the impact damping is full", 1e-4, 0.1)] = 0.002
    J_d: Annotated[float, Real("kg.m2", "inertia of the difference motion of the side gears", 0.01, 1.0)] = 0.03
    d_d: Annotated[float, Real("N.m.s/rad", "damping of the difference motion", 0.0, 50.0)] = 5.0
    J_p: Annotated[float, Real("kg.m2", "inertia of the powertrain block on its mounts", 0.5, 500.0)] = 6.0
    k_p: Annotated[float, Real("N.m/rad", "stiffness of the mounts", 1e3, 1e7)] = 70000.0
    d_p: Annotated[float, Real("N.m.s/rad", "damping of the mounts", 0.0, 20000.0)] = 120.0
    c_slip: vehicle.SlipStiffness = CAR.c_slip
    sigma: Annotated[float, Real("m", "relaxation length of the tyres", 0.05, 1.0)] = 0.22
    mu: Annotated[float, Real("1", "friction coefficient of the road", 0.05, 2.0, tunable=True)] = 1.0
    C_x: Annotated[float, Real("1", "shape factor of the tyre characteristic", 1.0, 2.5)] = 1.65
    t_asym: Annotated[float, Real("1", "asymmetry of the tyre stiffness", -0.5, 0.5)] = 0.05
    F_z0: Annotated[float, Real("N", "static load of the driven axle", 500.0, 200000.0)] = 8500.0
    m_h: Annotated[float, Real("kg", "unsprung mass of the driven axle", 10.0, 2500.0)] = 90.0
    k_x: Annotated[float, Real("N/m", "fore-aft stiffness of the hub bushings", 1e4, 1e8)] = 1.6e6
    d_x: Annotated[float, Real("N.s/m", "fore-aft damping of the hub bushings", 0.0, 100000.0)] = 1500.0
    J_y: Annotated[float, Real("kg.m2", "pitch inertia of the body", 100.0, 500000.0)] = 1600.0
    k_th: Annotated[float, Real("N.m/rad", "pitch stiffness of the suspension", 1e4, 1e7)] = 125000.0
    d_th: Annotated[float, Real("N.m.s/rad", "pitch damping of the suspension", 0.0, 500000.0)] = 7000.0
    h: Annotated[float, Real("m", "height of the centre of gravity", 0.1, 3.0)] = 0.55
    L_w: Annotated[float, Real("m", "wheelbase", 1.0, 10.0)] = 2.42
    c_fm: Annotated[float, Real("N.m", "friction of the rotor", 0.0, 20.0)] = 0.6
    omega_fm: Annotated[float, Real("rad/s", "speed at which the rotor friction sets in", 0.1, 100.0)] = 5.0
    c_fg: Annotated[float, Real("N.m", "friction of the carrier, wheel side", 0.0, 100.0)] = 5.0
    omega_fg: Annotated[float, Real("rad/s", "speed at which the carrier friction sets in", 0.05, 100.0)] = 0.5
    v_fg: Annotated[float, Real("N.m.s/rad", "viscous friction of the carrier", 0.0, 20.0)] = 0.2
    pp: Annotated[float, Real("1", "pole pairs of the motor", 1.0, 20.0)] = 2.0
    r_6a: Annotated[float, Real("N.m", "sixth-order torque ripple without load", 0.0, 20.0)] = 0.4
    r_6b: Annotated[float, Real("1", "sixth-order torque ripple over the torque", 0.0, 0.2)] = 0.008
    r_12a: Annotated[float, Real("N.m", "twelfth-order torque ripple without load", 0.0, 20.0)] = 0.15
    r_12b: Annotated[float, Real("1", "twelfth-order torque ripple over the torque", 0.0, 0.2)] = 0.003
    omega_rip: Annotated[float, Real("rad/s", "speed at which the ripple has halved", 1.0, 1000.0)] = 100.0
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
    g_muL: Annotated[
        float, Real("1", "friction of the road under the left wheel, over mu", 0.02, 2.0, tunable=True)
    ] = 1.0
    g_muR: Annotated[
        float, Real("1", "friction of the road under the right wheel, over mu", 0.02, 2.0, tunable=True)
    ] = 1.0


class State(NamedTuple):
    omega_1: Annotated[float, Real("rad/s", "speed of the rotor relative to its housing")]
    theta_1: Annotated[float, Real("rad", "angle of the rotor", nominal=10.0)]
    theta_p: Annotated[float, Real("rad", "rotation of the powertrain block, in wheel direction", nominal=0.01)]
    omega_p: Annotated[float, Real("rad/s", "rotational speed of the powertrain block", nominal=1.0)]
    gamma: Annotated[float, Real("rad", "twist of the gear stage", nominal=0.01)]
    omega_g: Annotated[float, Real("rad/s", "speed of the differential carrier")]
    omega_d: Annotated[float, Real("rad/s", "half the speed difference of the side gears, left - right", nominal=1.0)]
    x_L: Annotated[float, Real("rad", "twist of the left half shaft", nominal=0.01)]
    x_R: Annotated[float, Real("rad", "twist of the right half shaft", nominal=0.01)]
    omega_L: Annotated[float, Real("rad/s", "speed of the left wheel")]
    omega_R: Annotated[float, Real("rad/s", "speed of the right wheel")]
    u_L: Annotated[float, Real("m", "deflection of the left tyre", nominal=0.001)]
    u_R: Annotated[float, Real("m", "deflection of the right tyre", nominal=0.001)]
    z_L: Annotated[float, Real("rad", "twist of the left brake bristles", nominal=0.005)]
    z_R: Annotated[float, Real("rad", "twist of the right brake bristles", nominal=0.005)]
    s_h: Annotated[float, Real("m", "fore-aft deflection of the hub bushings", nominal=0.001)]
    v_h: Annotated[float, Real("m/s", "speed of the hubs")]
    v: Annotated[float, Real("m/s", "speed of the body")]
    theta_b: Annotated[float, Real("rad", "pitch of the body, nose up", nominal=0.01)]
    omega_b: Annotated[float, Real("rad/s", "pitch rate of the body", nominal=0.1)]


class Wheels(NamedTuple):
    """What acts at the two driven wheels: tyre forces (N), rolling and brake torques (N.m)."""

    F_L: float
    F_R: float
    T_rL: float
    T_rR: float
    T_brL: float
    T_brR: float
    dz_L: float
    dz_R: float


def start(u: Input, p: Parameters) -> State:
    """Standstill, or rolling at v_0 with the motor torque T_0 on a level road, almost stationary."""
    v, T_0, i, r = p.v_0, p.T_0, p.i, p.r
    f_r = p.c_fg + p.v_fg * v / r
    driving = i * (T_0 - p.c_fm) / r - f_r / r
    inertia = p.m + (p.J_1 * i * i + p.J_g + p.J_w) / (r * r)
    a = (driving - p.m * p.g * p.c_rr - p.c_wa * v * v) / inertia
    T_g = i * (T_0 - p.c_fm - p.J_1 * i * a / r)
    T_s = T_g - f_r - p.J_g * a / r
    F = (T_s - p.J_w * a / r) / r - p.c_rr * p.F_z0
    slip = F / p.c_slip
    w = v * (1.0 + slip) / r
    T_h = -(T_0 - p.c_fm) - (1.0 - 1.0 / i) * T_g
    F_h = F - p.m_h * a
    theta_b = (F_h * (p.h - r) - T_h) / p.k_th
    rolling = State(
        omega_1=i * w,
        theta_1=0.0,
        theta_p=T_h / p.k_p - theta_b,
        omega_p=0.0,
        gamma=T_g / p.k_g + sign(T_g) * p.phi_B / i,
        omega_g=w,
        omega_d=0.0,
        x_L=T_s / (p.k_s * (1.0 - p.asym)),
        x_R=T_s / (p.k_s * (1.0 + p.asym)),
        omega_L=w,
        omega_R=w,
        u_L=p.sigma * slip,
        u_R=p.sigma * slip,
        z_L=p.z_br,
        z_R=p.z_br,
        s_h=F_h / p.k_x,
        v_h=v,
        v=v,
        theta_b=theta_b,
        omega_b=0.0,
    )
    return State(*(where(v > 0.0, value, 0.0) for value in rolling))


def gear_torque(x: State, p: Parameters) -> float:
    """Torque of the gear stage at the carrier: spring and impact damper that never pull."""
    dgamma = 1.0 / p.i * x.omega_1 + x.omega_p - x.omega_g
    y = dead_zone(x.gamma, p.phi_B / p.i)
    T_g = p.k_g * y + p.d_g * dgamma * minimum(1.0, 1.0 / p.y_g * abs(y))
    return where(T_g * y > 0.0, T_g, 0.0)


def slow(rate: float) -> float:
    """Share of a ripple that turns at that rate (rad/s) which is integrated: all of it up to RIPPLE_FULL."""
    s = clip(1.0 / (RIPPLE_NONE - RIPPLE_FULL) * (RIPPLE_NONE - rate), 0.0, 1.0)
    return s * s * (3.0 - 2.0 * s)


def air_gap_torque(x: State, u: Input, p: Parameters) -> float:
    """Motor torque with ripple, less the friction of the rotor."""
    ratio = 1.0 / p.omega_rip * x.omega_1
    load, rate, angle = abs(u.T_mot), 6.0 * p.pp * abs(x.omega_1), 6.0 * p.pp * x.theta_1
    sixth = (p.r_6a + p.r_6b * load) * slow(rate)
    twelfth = (p.r_12a + p.r_12b * load) * slow(2.0 * rate)
    ripple = sin(angle) * (sixth + 2.0 * twelfth * cos(angle))
    return u.T_mot + ripple / (1.0 + ratio * ratio) - p.c_fm * tanh(1.0 / p.omega_fm * x.omega_1)


def tyre_force(u: float, damping: float, share: float, mu: float, F_z: float, p: Parameters) -> float:
    """Force in N of one tyre with the deflection u (m): no more than its road can give.

    Args:
        damping: that keeps a standing car from swinging, N. Without a limit it would push with many times the grip
            where wheels spin while the car hardly moves.
        share: of the stiffness, over that of half the axle.
        mu: friction coefficient of the road under it.
        F_z: load of the axle in N.
    """
    B = p.c_slip / (p.C_x * mu * p.F_z0) / p.sigma * share
    F_max = 0.5 * mu * F_z
    return clip(F_max * sin(p.C_x * atan(B * u)) + damping, -F_max, F_max)


def wheels(x: State, u: Input, p: Parameters) -> Wheels:
    F_z = maximum(200.0, p.F_z0 - 1.0 / p.L_w * (p.k_th * x.theta_b + p.d_th * x.omega_b))
    d = 0.5 * vehicle.standstill_damping(x.v_h, p)
    dz_L = brake.bristle_rate(x.omega_L, x.z_L, p)
    dz_R = brake.bristle_rate(x.omega_R, x.z_R, p)
    rolling = 0.5 * p.c_rr * p.r * F_z
    return Wheels(
        F_L=tyre_force(x.u_L, d * (p.r * x.omega_L - x.v_h), 1.0 - p.t_asym, p.mu * p.g_muL, F_z, p),
        F_R=tyre_force(x.u_R, d * (p.r * x.omega_R - x.v_h), 1.0 + p.t_asym, p.mu * p.g_muR, F_z, p),
        T_rL=rolling * tanh(p.r / p.v_rr * x.omega_L),
        T_rR=rolling * tanh(p.r / p.v_rr * x.omega_R),
        T_brL=0.5 * u.T_brake * brake.grip(x.z_L, dz_L, p),
        T_brR=0.5 * u.T_brake * brake.grip(x.z_R, dz_R, p),
        dz_L=dz_L,
        dz_R=dz_R,
    )


def body_acceleration(x: State, u: Input, F_h: float, p: Parameters) -> float:
    """Acceleration in m/s2 of the body under the bushing force F_h (N)."""
    return 1.0 / (p.m - p.m_h) * (F_h - vehicle.resistance(x.v, u.slope, p.m * p.g - p.F_z0, p))


def bushing_force(x: State, p: Parameters) -> float:
    return p.k_x * x.s_h + p.d_x * (x.v_h - x.v)


def derivative(x: State, u: Input, p: Parameters) -> State:
    T_g = gear_torque(x, p)
    T_a = air_gap_torque(x, u, p)
    T_h = p.k_p * (x.theta_p + x.theta_b) + p.d_p * (x.omega_p + x.omega_b)
    domega_p = 1.0 / p.J_p * (-T_a - (1.0 - 1.0 / p.i) * T_g - T_h)

    dx_L = x.omega_g + x.omega_d - x.omega_L
    dx_R = x.omega_g - x.omega_d - x.omega_R
    T_L = 0.5 * (p.k_s * (1.0 - p.asym) * x.x_L + p.d_s * dx_L)
    T_R = 0.5 * (p.k_s * (1.0 + p.asym) * x.x_R + p.d_s * dx_R)
    friction = p.c_fg * tanh(1.0 / p.omega_fg * x.omega_g) + p.v_fg * x.omega_g

    k = wheels(x, u, p)
    rim_L, rim_R, v_h = p.r * x.omega_L, p.r * x.omega_R, x.v_h
    F_h = bushing_force(x, p)
    pitching = F_h * (p.h - p.r) - T_h - k.T_brL - k.T_brR - p.k_th * x.theta_b - p.d_th * x.omega_b
    return State(
        omega_1=1.0 / p.J_1 * (T_a - 1.0 / p.i * T_g) - domega_p,
        theta_1=x.omega_1,
        theta_p=x.omega_p,
        omega_p=domega_p,
        gamma=1.0 / p.i * x.omega_1 + x.omega_p - x.omega_g,
        omega_g=1.0 / p.J_g * (T_g - T_L - T_R - friction),
        omega_d=1.0 / p.J_d * (T_R - T_L - p.d_d * x.omega_d),
        x_L=dx_L,
        x_R=dx_R,
        omega_L=2.0 / p.J_w * (T_L - p.r * k.F_L - k.T_rL - k.T_brL),
        omega_R=2.0 / p.J_w * (T_R - p.r * k.F_R - k.T_rR - k.T_brR),
        u_L=rim_L - v_h - 1.0 / p.sigma * maximum(abs(rim_L), abs(v_h)) * x.u_L,
        u_R=rim_R - v_h - 1.0 / p.sigma * maximum(abs(rim_R), abs(v_h)) * x.u_R,
        z_L=k.dz_L,
        z_R=k.dz_R,
        s_h=v_h - x.v,
        v_h=1.0 / p.m_h * (k.F_L + k.F_R - F_h),
        v=body_acceleration(x, u, F_h, p),
        theta_b=x.omega_b,
        omega_b=1.0 / p.J_y * pitching,
    )


def output(x: State, u: Input, p: Parameters) -> Output:
    k = wheels(x, u, p)
    T_rim = p.r * (k.F_L + k.F_R) + k.T_rL + k.T_rR
    return Output(
        omega_1=x.omega_1,
        omega_2=0.5 * p.i * (x.omega_L + x.omega_R),
        omega_wheel_L=x.omega_L,
        omega_wheel_R=x.omega_R,
        T_gear=1.0 / p.i * gear_torque(x, p),
        T_load=-1.0 / p.i * (T_rim + k.T_brL + k.T_brR),
        T_rim=T_rim,
        phi=p.i * (x.gamma + 0.5 * (x.x_L + x.x_R) - x.theta_p),
        v=x.v,
        a_body=body_acceleration(x, u, bushing_force(x, p), p),
        pitch=x.theta_b,
    )


def event_indicators(x: State, u: Input, p: Parameters) -> tuple[float, ...]:
    """Where the equations have kinks.

    The flanks of the gap, the penetrations at which the impact damping is full, wheels at rest (the
    brake bristles turn round), wheels without slip (the rate of the tyre changes).
    """
    flank = p.phi_B / p.i
    return (
        x.gamma - flank,
        x.gamma + flank,
        x.gamma - flank - p.y_g,
        x.gamma + flank + p.y_g,
        x.omega_L,
        x.omega_R,
        p.r * x.omega_L - x.v_h,
        p.r * x.omega_R - x.v_h,
    )


BLOCK = ContinuousBlock(
    name="ValidationVehicle",
    description="Validation model: motor with ripple, mounts, differential, half shafts, tyres, hubs, body",
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
    allowed_error=ALLOWED_ERROR,
)

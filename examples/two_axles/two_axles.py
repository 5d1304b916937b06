"""A car with a drive unit at each axle: two motors, two elastic gears with backlash, one body.

J_1 domega_1/dt = T_mot - T_gear          of each axle; T_gear = C b(phi, phi_B), dphi/dt = omega_1 - omega_2
J_2 domega_2/dt = T_gear - r F/i          F = k (r omega_2/i - v), a tyre that slips in proportion to its force
    m dv/dt     = F_front + F_rear - brake, slope and rolling resistance

driveline build examples/two_axles/two_axles.py
driveline compare --plant build/native/TwoAxles.fmu --topology examples/two_axles/two_axles.toml
"""

from typing import Annotated, NamedTuple

from driveline import ContinuousBlock, Fmu, Real, operators

Torque = Annotated[float, Real("N.m", "air-gap torque of a motor", -2000.0, 2000.0, 100.0)]
Speed = Annotated[float, Real("rad/s", "speed, motor side")]
WheelSpeed = Annotated[float, Real("rad/s", "speed of the wheels of an axle, wheel side", nominal=50.0)]
Twist = Annotated[float, Real("rad", "twist of a drive train, motor side")]
GearTorque = Annotated[float, Real("N.m", "gear torque, motor side, positive when it drives")]


class Parameters(NamedTuple):
    J_1: Annotated[float, Real("kg.m2", "inertia of a motor", 0.001, 1.0)] = 0.055
    J_2: Annotated[float, Real("kg.m2", "inertia of the wheels of an axle, motor side", 0.001, 5.0)] = 0.15
    C_front: Annotated[float, Real("N.m/rad", "stiffness of the front drive train", 1.0, 1e4)] = 117.4
    C_rear: Annotated[float, Real("N.m/rad", "stiffness of the rear drive train", 1.0, 1e4)] = 160.0
    phi_B: Annotated[float, Real("rad", "half the gap, motor side", 0.0, 1.0)] = 0.1
    i: Annotated[float, Real("1", "gear ratio", 1.0, 20.0)] = 9.0
    r: Annotated[float, Real("m", "radius of the wheels", 0.1, 1.0)] = 0.3
    m: Annotated[float, Real("kg", "mass of the car", 500.0, 5000.0)] = 2200.0
    k: Annotated[float, Real("N.s/m", "slip stiffness of the tyres of an axle", 100.0, 1e5)] = 6000.0
    c_rr: Annotated[float, Real("1", "rolling resistance", 0.0, 0.1)] = 0.01
    c_wa: Annotated[float, Real("N.s2/m2", "air drag", 0.0, 10.0)] = 0.4
    g: Annotated[float, Real("m/s2", "gravity", 1.0, 20.0)] = 9.81
    v_0: Annotated[float, Real("m/s", "speed at the start", 0.0, 100.0)] = 0.0
    T_0: Annotated[float, Real("N.m", "torque of each motor at the start", -2000.0, 2000.0)] = 0.0


class Input(NamedTuple):
    T_mot_front: Torque = 0.0
    T_mot_rear: Torque = 0.0
    T_brake: Annotated[float, Real("N.m", "brake torque capacity, wheel side", 0.0, 20000.0, 1000.0)] = 0.0
    slope: Annotated[float, Real("rad", "slope of the road, positive uphill", -0.5, 0.5, 0.1)] = 0.0


class State(NamedTuple):
    omega_1_front: Speed
    omega_1_rear: Speed
    omega_2_front: Speed
    omega_2_rear: Speed
    phi_front: Twist
    phi_rear: Twist
    v: Annotated[float, Real("m/s", "speed of the car")]


class Output(NamedTuple):
    omega_1_front: Speed
    omega_1_rear: Speed
    omega_2_front: Speed
    omega_2_rear: Speed
    omega_wheel_front: WheelSpeed
    omega_wheel_rear: WheelSpeed
    T_gear_front: GearTorque
    T_gear_rear: GearTorque
    phi_front: Twist
    phi_rear: Twist
    v: Annotated[float, Real("m/s", "speed of the vehicle")]
    a_body: Annotated[float, Real("m/s2", "longitudinal acceleration of the body")]


def start(u: Input, p: Parameters) -> State:
    """Standstill, or rolling at v_0 with the torque T_0 of each motor on its flank."""
    omega = p.i * p.v_0 / p.r
    front, rear = (
        operators.where(p.v_0 > 0.0, p.T_0 / C + operators.sign(p.T_0) * p.phi_B, 0.0) for C in (p.C_front, p.C_rear)
    )
    return State(omega, omega, omega, omega, front, rear, p.v_0)


def gear_torques(x: State, p: Parameters) -> tuple[float, float]:
    """Of the front and the rear drive train, in N.m."""
    front, rear = (phi - operators.clip(phi, -p.phi_B, p.phi_B) for phi in (x.phi_front, x.phi_rear))
    return p.C_front * front, p.C_rear * rear


def derivative(x: State, u: Input, p: Parameters) -> State:
    T_front, T_rear = gear_torques(x, p)
    F_front, F_rear = (p.k * (p.r / p.i * omega - x.v) for omega in (x.omega_2_front, x.omega_2_rear))
    rolling = operators.clip(x.v / 0.1, -1.0, 1.0)  # the brake and the tyres hold the car at rest
    resistance = rolling * (u.T_brake / p.r + p.m * p.g * p.c_rr) + p.c_wa * x.v * abs(x.v) + p.m * p.g * u.slope
    return State(
        omega_1_front=(u.T_mot_front - T_front) / p.J_1,
        omega_1_rear=(u.T_mot_rear - T_rear) / p.J_1,
        omega_2_front=(T_front - p.r / p.i * F_front) / p.J_2,
        omega_2_rear=(T_rear - p.r / p.i * F_rear) / p.J_2,
        phi_front=x.omega_1_front - x.omega_2_front,
        phi_rear=x.omega_1_rear - x.omega_2_rear,
        v=(F_front + F_rear - resistance) / p.m,
    )


def output(x: State, u: Input, p: Parameters) -> Output:
    wheels = (omega / p.i for omega in (x.omega_2_front, x.omega_2_rear))
    twists = x.phi_front, x.phi_rear
    return Output(*x[:4], *wheels, *gear_torques(x, p), *twists, x.v, derivative(x, u, p).v)


BLOCK = ContinuousBlock(
    name="TwoAxles",
    description="A car with a drive unit at each axle",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=Output,
    start=start,
    output=output,
    derivative=derivative,
    step_size=0.001,
)

FMU = Fmu(BLOCK, stop_time=10.0)

"""What several blocks know of the vehicle: drive train, tyre, resistance to motion, start of the run."""

from typing import Annotated, NamedTuple, Protocol

from fmublocks.block.declaration import Real
from fmublocks.block.operators import sin, tanh

StartSpeed = Annotated[float, Real("m/s", "speed at the start, stationary rolling on level road", 0.0, 70.0, 10.0)]
StartTorque = Annotated[float, Real("N.m", "stationary motor torque at a rolling start", -1000.0, 1000.0, 100.0)]
MotorInertia = Annotated[float, Real("kg.m2", "inertia of the motor and its side of the gear", 0.001, 10.0)]
WheelInertia = Annotated[float, Real("kg.m2", "inertia from the gear to the wheels, motor side", 0.001, 100.0)]
Stiffness = Annotated[float, Real("N.m/rad", "stiffness of the drive train, motor side", 1.0, 1e5)]
HalfGap = Annotated[float, Real("rad", "half the backlash, motor side", 0.0, 3.0)]
MotorTorque = Annotated[float, Real("N.m", "largest torque of the motor, either sign", 1.0, 2000.0, tunable=True)]
MotorLag = Annotated[float, Real("s", "time constant of the torque loop", 1e-3, 0.1)]
GearRatio = Annotated[float, Real("1", "gear ratio, motor speed over wheel speed", 1.0, 30.0)]
Mass = Annotated[float, Real("kg", "mass of the vehicle", 300.0, 40000.0, tunable=True)]
WheelRadius = Annotated[float, Real("m", "radius of the driven wheels", 0.1, 1.0)]
SlipStiffness = Annotated[float, Real("N", "longitudinal slip stiffness of the driven axle", 1e4, 5e6)]
LowSpeedDamping = Annotated[float, Real("N.s/m", "tyre damping at standstill, fading with speed", 0.0, 20000.0)]
LowSpeed = Annotated[float, Real("m/s", "speed at which the tyre damping has halved", 0.01, 10.0)]
RollingResistance = Annotated[float, Real("1", "rolling resistance coefficient", 0.0, 0.1, tunable=True)]
RollingSpeed = Annotated[float, Real("m/s", "speed at which rolling resistance sets in", 0.01, 10.0)]
AirDrag = Annotated[float, Real("N.s2/m2", "air drag over the square of speed", 0.0, 10.0, tunable=True)]
Gravity = Annotated[float, Real("m/s2", "gravitational acceleration", 1.0, 20.0)]


class Vehicle(NamedTuple):
    """The car that all blocks start with: where two of them know the same of it, they take it from here."""

    J_1: MotorInertia = 0.055
    J_2: WheelInertia = 0.30
    C: Stiffness = 117.4
    phi_B: HalfGap = 0.157
    T_max: MotorTorque = 180.0
    tau: MotorLag = 0.003
    i: GearRatio = 9.0
    m: Mass = 1450.0
    r: WheelRadius = 0.29
    c_slip: SlipStiffness = 140000.0
    d_low: LowSpeedDamping = 4000.0
    v_low: LowSpeed = 0.5
    c_rr: RollingResistance = 0.012
    v_rr: RollingSpeed = 0.1
    c_wa: AirDrag = 0.42
    g: Gravity = 9.81


CAR = Vehicle()


class ResistanceParameters(Protocol):
    """Those of the resistance to motion, whatever else is in the record."""

    @property
    def m(self) -> float: ...
    @property
    def g(self) -> float: ...
    @property
    def c_rr(self) -> float: ...
    @property
    def v_rr(self) -> float: ...
    @property
    def c_wa(self) -> float: ...


class LowSpeedParameters(Protocol):
    """Those of the tyre at standstill, whatever else is in the record."""

    @property
    def d_low(self) -> float: ...
    @property
    def v_low(self) -> float: ...


class MotorParameters(Protocol):
    """Those of the motor, whatever else is in the record."""

    @property
    def T_max(self) -> float: ...
    @property
    def J_1(self) -> float: ...


def added_speed(p: MotorParameters, T_s: float) -> float:
    """Speed in rad/s that T_max adds to the free motor in a sample: the unit of a controller's thresholds of speeds."""
    return p.T_max * T_s / p.J_1


def resistance(v: float, slope: float, rolling_load: float, p: ResistanceParameters) -> float:
    """Force in N against the motion: rolling (rolling_load in N), grade and air."""
    return rolling_load * p.c_rr * tanh(1.0 / p.v_rr * v) + p.m * p.g * sin(slope) + p.c_wa * v * abs(v)


def standstill_damping(v: float, p: LowSpeedParameters) -> float:
    """Tyre damping in N.s/m that keeps a standing car from swinging."""
    ratio = 1.0 / p.v_low * v
    return p.d_low / (1.0 + ratio * ratio)

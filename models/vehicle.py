"""What every plant knows of the vehicle: start of the run, tyre, resistance to motion."""

from typing import Annotated, Any

from .block.declaration import Real
from .block.operators import sin, tanh

StartSpeed = Annotated[float, Real("m/s", "speed at the start, stationary rolling on level road", 0.0, 70.0, 10.0)]
StartTorque = Annotated[float, Real("N.m", "stationary motor torque at a rolling start", -1000.0, 1000.0, 100.0)]
MotorInertia = Annotated[float, Real("kg.m2", "inertia of the motor and its side of the gear", 0.001, 10.0)]
HalfGap = Annotated[float, Real("rad", "half the backlash, motor side", 0.0, 3.0)]
GearRatio = Annotated[float, Real("1", "gear ratio, motor speed over wheel speed", 1.0, 30.0)]
Mass = Annotated[float, Real("kg", "mass of the vehicle", 300.0, 10000.0)]
WheelRadius = Annotated[float, Real("m", "radius of the driven wheels", 0.1, 1.0)]
SlipStiffness = Annotated[float, Real("N", "longitudinal slip stiffness of the driven axle", 1e4, 1e6)]
LowSpeedDamping = Annotated[float, Real("N.s/m", "tyre damping at standstill, fading with speed", 0.0, 20000.0)]
LowSpeed = Annotated[float, Real("m/s", "speed at which the tyre damping has halved", 0.01, 10.0)]
RollingResistance = Annotated[float, Real("1", "rolling resistance coefficient", 0.0, 0.1)]
RollingSpeed = Annotated[float, Real("m/s", "speed at which rolling resistance sets in", 0.01, 10.0)]
AirDrag = Annotated[float, Real("N.s2/m2", "air drag over the square of speed", 0.0, 10.0)]
Gravity = Annotated[float, Real("m/s2", "gravitational acceleration", 1.0, 20.0)]


def resistance(v: Any, slope: Any, rolling_load: Any, p: Any) -> Any:
    """Force in N against the motion: rolling (rolling_load in N), grade and air."""
    return rolling_load * p.c_rr * tanh(v / p.v_rr) + p.m * p.g * sin(slope) + p.c_wa * v * abs(v)


def standstill_damping(v: Any, p: Any) -> Any:
    """Tyre damping in N.s/m that keeps a standing car from swinging."""
    ratio = v / p.v_low
    return p.d_low / (1.0 + ratio * ratio)

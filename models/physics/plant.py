"""The interface that every plant has: what drives and brakes it, and what can be seen of it."""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real


class Input(NamedTuple):
    """Torques and road acting on the drive train."""

    T_mot: Annotated[float, Real("N.m", "air-gap torque of the motor", -2000.0, 2000.0, 100.0)] = 0.0
    T_brake: Annotated[
        float, Real("N.m", "brake torque capacity of the driven wheels, wheel side", 0.0, 20000.0, 1000.0)
    ] = 0.0
    slope: Annotated[float, Real("rad", "slope of the road, positive uphill", -0.5, 0.5, 0.1)] = 0.0
    T_load_rec: Annotated[
        float,
        Real("N.m", "recorded load torque, motor side; used only with recorded_load", -2000.0, 2000.0, 100.0),
    ] = 0.0


class Output(NamedTuple):
    """Motions and torques of the drive train; the order is the same for every plant."""

    omega_1: Annotated[float, Real("rad/s", "speed of the motor")]
    omega_2: Annotated[float, Real("rad/s", "mean speed of the driven wheels, motor side")]
    omega_wheel_L: Annotated[float, Real("rad/s", "speed of the left driven wheel, wheel side", nominal=50.0)]
    omega_wheel_R: Annotated[float, Real("rad/s", "speed of the right driven wheel, wheel side", nominal=50.0)]
    T_gear: Annotated[float, Real("N.m", "gear torque, motor side, positive when it drives")]
    T_load: Annotated[float, Real("N.m", "load torque on the wheels, motor side, negative when it brakes")]
    T_rim: Annotated[float, Real("N.m", "torque at the wheel rims, wheel side, without the brakes", nominal=1000.0)]
    phi: Annotated[float, Real("rad", "twist of the drive train, motor side")]
    v: Annotated[float, Real("m/s", "speed of the vehicle")]
    a_body: Annotated[float, Real("m/s2", "longitudinal acceleration of the body")]
    pitch: Annotated[float, Real("rad", "pitch of the body, positive nose up", nominal=0.01)]

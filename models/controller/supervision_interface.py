"""What every controller is given: its inputs, and the parameters of the supervision."""

from typing import Annotated, NamedTuple

from ..block.declaration import Boolean, Integer, Real
from ..physics.vehicle import CAR, MotorInertia, MotorLag


class Parameters(NamedTuple):
    """Of the supervision, for every controller."""

    T_max: Annotated[float, Real("N.m", "limit of the torque reference", 1.0, 2000.0)] = CAR.T_max
    tau: MotorLag = CAR.tau
    J_1: MotorInertia = CAR.J_1
    T_take_max: Annotated[
        float, Real("N.m", "largest torque taken from the demand, by damping and landing", 0.0, 2000.0)
    ] = 100.0
    T_add_max: Annotated[float, Real("N.m", "largest torque added to the demand, or taken by damping", 0.0, 2000.0)] = (
        60.0
    )
    t_fade: Annotated[float, Real("s", "time to fade between modes", 0.002, 5.0)] = 0.1
    t_bad: Annotated[float, Real("s", "bad motor signals for so long lead to fallback", 0.0, 1.0)] = 0.02
    t_apart: Annotated[float, Real("s", "contradiction by the wheel speed for so long leads to it", 0.0, 1.0)] = 0.1
    t_proof: Annotated[float, Real("s", "good motor signals for so long end the fallback", 0.01, 1.0)] = 0.15
    t_frozen: Annotated[float, Real("s", "a motor speed unchanged for so long is frozen", 0.01, 10.0)] = 0.1
    t_stale: Annotated[float, Real("s", "no message for so long ends the mode with wheel speed", 0.01, 10.0)] = 0.1
    T_still: Annotated[float, Real("N.m", "largest demand at rest", 0.0, 20.0)] = 2.0
    omega_still: Annotated[float, Real("rad/s", "largest motor speed at rest", 0.0, 20.0)] = 3.0
    t_rest: Annotated[float, Real("s", "time below both after which the car is at rest", 0.0, 10.0)] = 0.3
    omega_max: Annotated[float, Real("rad/s", "largest plausible speed", 10.0, 5000.0)] = 3000.0
    e_max: Annotated[float, Real("rad/s", "largest distance of a usable wheel speed", 1.0, 1000.0)] = 40.0
    e_jump: Annotated[float, Real("rad/s", "largest jump of the motor speed in a sample", 1.0, 1000.0)] = 8.0
    e_wheel: Annotated[float, Real("rad/s", "largest distance of the motor from the wheel speed", 1.0, 1000.0)] = 30.0


class Input(NamedTuple):
    T_driver: Annotated[float, Real("N.m", "torque demanded by the driver")] = 0.0
    omega_1_meas: Annotated[float, Real("rad/s", "measured speed of the motor")] = 0.0
    T_mot_est: Annotated[float, Real("N.m", "air-gap torque as motor control estimates it")] = 0.0
    omega_2_can: Annotated[float, Real("rad/s", "received speed of the driven wheels, motor side")] = 0.0
    valid: Annotated[bool, Boolean("the received wheel speed is above its minimum")] = False
    counter: Annotated[int, Integer("one more with every message that arrives")] = 0
    enable: Annotated[bool, Boolean("damping on")] = True

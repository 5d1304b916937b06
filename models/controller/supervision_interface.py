"""What every controller is given: its inputs, and the parameters of the supervision."""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Boolean, Integer, Real

from ..physics.vehicle import CAR, MotorInertia, MotorLag
from .gains import GAINS


def speed(meaning: str) -> Real:
    """The declaration of a threshold of speeds, in units of vehicle.added_speed."""
    return Real("1", f"{meaning}, over T_max T_s/J_1", 0.0, 1000.0)


class Parameters(NamedTuple):
    """Of the supervision, for every controller."""

    T_max: Annotated[float, Real("N.m", "limit of the torque reference", 1.0, 2000.0)] = CAR.T_max
    tau: MotorLag = CAR.tau
    J_1: MotorInertia = CAR.J_1
    T_take_max: Annotated[
        float, Real("N.m", "largest torque taken from the demand, by damping and landing", 0.0, 2000.0, tunable=True)
    ] = GAINS["T_take_max"]
    T_add_max: Annotated[
        float, Real("N.m", "largest torque added to the demand, or taken by damping", 0.0, 2000.0, tunable=True)
    ] = GAINS["T_add_max"]
    t_fade: Annotated[float, Real("s", "time to fade between modes", 0.002, 5.0)] = 0.1
    t_bad: Annotated[float, Real("s", "bad motor signals for so long lead to fallback", 0.0, 1.0)] = 0.02
    t_apart: Annotated[float, Real("s", "contradiction by wheels, or a reversal, takes so long", 0.002, 1.0)] = 0.1
    t_proof: Annotated[float, Real("s", "good motor signals for so long end the fallback", 0.01, 1.0)] = 0.15
    t_turn: Annotated[float, Real("s", "the same after the motor speed has changed its sign", 0.01, 10.0)] = 1.0
    t_stale: Annotated[float, Real("s", "no message for so long ends the mode with wheel speed", 0.01, 10.0)] = 0.1
    T_frame: Annotated[float, Real("s", "from one frame of motor control to the next, by its counter", 1e-4, 0.1)] = (
        0.002
    )
    t_late: Annotated[float, Real("s", "time for which messages may tell what the motor speed was", 0.01, 1.0)] = 0.08
    t_move: Annotated[float, Real("s", "time for which an expected movement is remembered", 0.01, 10.0)] = 0.1
    t_forget: Annotated[float, Real("s", "time after which a half swing is forgotten", 0.01, 100.0)] = 0.5
    t_relapse: Annotated[float, Real("s", "the same where there is no damping any more", 0.01, 100.0)] = 4.0
    T_still: Annotated[float, Real("N.m", "largest demand at rest", 0.0, 20.0)] = 2.0
    omega_still: Annotated[float, Real("rad/s", "largest motor speed at rest", 0.0, 20.0)] = 3.0
    t_rest: Annotated[float, Real("s", "time below both after which the car is at rest", 0.0, 10.0)] = 0.3
    omega_max: Annotated[float, Real("rad/s", "largest speed that need not be reached step by step", 10.0, 5000.0)] = (
        3000.0
    )
    q_omega: Annotated[float, Real("rad/s", "resolution of the measured motor speed", 0.0, 10.0)] = 0.1
    jump: Annotated[float, speed("largest jump of the motor speed in a sample")] = 1.25
    frozen: Annotated[float, speed("movement beside q_omega without which the motor speed is frozen")] = 0.15
    wheel_deviation: Annotated[float, speed("largest distance of the wheel speed from the motor speed")] = 4.6
    wheel_jump: Annotated[float, speed("largest change between messages that the motor speed does not make")] = 3.0
    launch_speed: Annotated[float, speed("speed of the free motor that tells the direction of a launch")] = 0.6
    launch_tolerance: Annotated[float, Real("1", "error of a launch against the torque, over it", 0.0, 1.0)] = 0.25
    g_radius: Annotated[float, Real("1", "largest error of the wheel radius", 0.0, 1.0)] = 0.06
    T_off: Annotated[float, Real("1", "largest error of the torque estimate, over T_max", 0.0, 1.0)] = 0.05
    g_off: Annotated[float, Real("1", "largest error of the torque estimate, over the torque", 0.0, 1.0)] = 0.35
    swing: Annotated[float, Real("1", "least damping torque of a half swing, over T_max", 1e-3, 1.0)] = 0.03
    swing_decay: Annotated[float, Real("1", "least half swing that counts, over the one before", 0.01, 10.0)] = 0.5
    demand_excuse: Annotated[float, Real("1", "change of demand that explains a half swing, over it", 0.01, 10.0)] = 0.9


class Input(NamedTuple):
    T_driver: Annotated[float, Real("N.m", "torque demanded by the driver")] = 0.0
    omega_1_meas: Annotated[float, Real("rad/s", "measured speed of the motor")] = 0.0
    T_mot_est: Annotated[float, Real("N.m", "air-gap torque as motor control estimates it")] = 0.0
    omega_2_can: Annotated[float, Real("rad/s", "received speed of the driven wheels, motor side")] = 0.0
    valid: Annotated[bool, Boolean("the received wheel speed is above its minimum")] = False
    counter: Annotated[int, Integer("one more with every message that arrives")] = 0
    enable: Annotated[bool, Boolean("damping on")] = True
    direction: Annotated[int, Integer("of the car, if the bus tells it: 1 forwards, -1 backwards, 0 not known")] = 0
    alive: Annotated[int, Integer("one more with every frame of motor control, if it is counted; 0 if not")] = 0
    slip_control: Annotated[bool, Boolean("a traction or brake control is active, if the bus tells it")] = False

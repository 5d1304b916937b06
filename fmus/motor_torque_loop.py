"""The FMU `MotorTorqueLoop`: the torque-controlled motor."""

from ..models.motor_torque_loop import BLOCK
from .fmu import Fmu

FMU = Fmu(BLOCK, stop_time=2.0)

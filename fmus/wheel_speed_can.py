"""The FMU `WheelSpeedCan`: the wheel speed from the bus."""

from ..models.wheel_speed_can import BLOCK
from .fmu import Fmu

FMU = Fmu(BLOCK, stop_time=10.0)

"""The FMU `DampingController`: estimator and damping control."""

from ..models.damping_controller import BLOCK
from .fmu import Fmu

FMU = Fmu(BLOCK, stop_time=10.0)

"""The FMU `ValidationVehicle`: the validation vehicle."""

from ..models.validation_vehicle import BLOCK
from .fmu import Fmu

FMU = Fmu(BLOCK, stop_time=10.0)

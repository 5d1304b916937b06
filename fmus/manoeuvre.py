"""The FMU `Manoeuvre`: what `driveline ssp` drives the loop with in other tools."""

from ..models.manoeuvre import BLOCK
from .fmu import Fmu

FMU = Fmu(BLOCK, stop_time=10.0)

"""The FMU `TwoMassDriveline`: the design model."""

from ..models.two_mass_driveline import BLOCK
from .fmu import Fmu

FMU = Fmu(BLOCK, stop_time=10.0)

"""The FMU `SignalFaults`: what `driveline faults` puts between the sensors and the controller."""

from ..models.signal_faults import BLOCK
from .fmu import Fmu

FMU = Fmu(BLOCK, stop_time=10.0)

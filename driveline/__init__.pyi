from .fmus.fmu import Fmu as Fmu
from .harness.manoeuvres.catalogue import MANOEUVRES as MANOEUVRES
from .harness.metrics.evaluate import evaluate as evaluate
from .harness.simulation.simulate import simulate as simulate

"""A run whose frames are looked at."""

import numpy as np
import pytest

from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate


@pytest.fixture(scope="session")
def results(native) -> np.ndarray:
    """Of a car that pulls away, so that the wheel speed becomes valid on the way."""
    return simulate(MANOEUVRES["launch"], folder=native.parent, parameters={"can.loss": 0.1})

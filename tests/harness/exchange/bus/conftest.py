"""A run whose frames are looked at."""

from pathlib import Path

import numpy as np
import pytest

from driveline.harness.commands.cli import main
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate


@pytest.fixture(scope="session")
def results(native) -> np.ndarray:
    """Of a car that pulls away, so that the wheel speed becomes valid on the way."""
    return simulate(MANOEUVRES["launch"], folder=native.parent, parameters={"can.loss": 0.1})


@pytest.fixture(scope="session")
def sender(native, tmp_path_factory) -> Path:
    """The FMU that sends the wheel speed over the bus."""
    folder = tmp_path_factory.mktemp("sender")
    assert main(["bus", "--fmu", "--output", str(folder), "--quiet"]) == 0
    return folder / "WheelSpeedCan.fmu"

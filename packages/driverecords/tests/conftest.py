"""What the tests of recordings share."""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest
from fmutesting.plugin import *  # noqa: F403

from driverecords.measurement import Measurement, read_measurement

from .car import RADIUS, RATIO

Write = Callable[[Mapping[str, np.ndarray]], Path]
Read = Callable[..., Measurement]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes columns by their headings to a CSV file."""

    def write(columns: Mapping[str, np.ndarray]) -> Path:
        path = tmp_path / "measured.csv"
        rows = np.column_stack(list(columns.values()))
        np.savetxt(path, rows, delimiter=",", header=",".join(columns), comments="", fmt="%.10g")
        return path

    return write


@pytest.fixture
def read(write: Write) -> Read:
    """Reads what would be written of a drive, in SI units."""

    def read(drive: Mapping[str, np.ndarray], **more: object) -> Measurement:
        units = {"time": "s", "T_ref": "N.m", "T_mot": "N.m", "T_load": "N.m"}
        path = write({f"{name} [{units.get(name, 'rad/s')}]": values for name, values in drive.items()})
        return read_measurement(path, RATIO, RADIUS, **more)  # type: ignore[arg-type]

    return read

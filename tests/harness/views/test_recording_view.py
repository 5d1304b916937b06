"""The figure of a recorded drive marks what is odd where it is."""

import numpy as np
import pytest

from driveline.harness.views.panels import Points
from driveline.harness.views.recording_view import _parts
from driverecords.channel_rules import SPIKED
from driverecords.channels import Channel
from driverecords.file_units import FileUnit
from driverecords.findings import Finding, at_samples
from driverecords.plausibility import RATE


def test_each_sample_that_is_odd_is_marked_in_the_units_of_the_file() -> None:
    written = np.where(np.isin(np.arange(100), (10, 40, 41)), -999.0, 1.0)
    time = 0.1 * np.arange(100)
    channel = Channel("T_mot", "T_mot", "N.m", time, 1e3 * written, "sample {}".format, FileUnit("kN.m", 1e3))
    found = [at_samples(channel, SPIKED, np.array([10, 40, 41]), "")]
    (points,) = (part for part in _parts(channel, found) if isinstance(part, Points))
    assert np.asarray(points.x) == pytest.approx([1.0, 4.0, 4.1])
    assert list(points.y) == [-999.0] * 3
    (points,) = (part for part in _parts(channel, [Finding(RATE, "T_mot", 2.0, "")]) if isinstance(part, Points))
    assert list(points.x) == [2.0]
    assert [*_parts(channel, [Finding(RATE, "another", 2.0, "")])][1:] == []

"""The bundled drive."""

import numpy as np

from driveline.harness.manoeuvres import town_drive
from driveline.harness.recordings.drive import read_drive


def test_the_bundled_file_is_what_its_script_writes(tmp_path):
    town_drive.write(tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_bytes() == town_drive.PATH.read_bytes()


def test_it_pulls_away_passes_zero_torque_and_stops_at_a_light():
    recording = read_drive(town_drive.PATH)
    moving = recording.v > 0.0
    starts = np.flatnonzero(moving[1:] & ~moving[:-1])
    stops = np.flatnonzero(~moving[1:] & moving[:-1])
    assert (len(starts), len(stops)) == (2, 2)
    crossings = np.flatnonzero(np.diff(np.sign(recording.T_mot[moving])))
    assert len(crossings) > 10

"""A recording is read whatever habit its logger has, or refused in a line that says what to do."""

import re
from pathlib import Path

import numpy as np
import pytest
from fmutesting.together import together

from driverecords.cells import is_missing
from driverecords.channel_rules import of_channels
from driverecords.channels import Channels
from driverecords.drive import read_drive
from driverecords.source import RecordingError
from driverecords.time_base import Cut

from .logger_texts import HABITS, TIME, T, V


@together("name", HABITS)
def test_a_habit_of_loggers(tmp_path: Path, name: str) -> None:
    habit, path = HABITS[name], tmp_path / "drive.csv"
    path.write_bytes(habit.content)
    if habit.refused:
        with pytest.raises(RecordingError, match=habit.refused) as refusal:
            read_drive(path, dict(habit.columns))
        assert str(refusal.value).isprintable()
        if offered := re.search(r"--from (\S+) --to (\S+)", str(refusal.value)):
            cut = Cut(*map(float, offered.groups()))
            piece = read_drive(path, dict(habit.columns), cut=cut)
            assert (piece.time[0], piece.time[-1]) == pytest.approx(cut)
        return
    drive = read_drive(path, dict(habit.columns))
    kept = np.array(habit.kept, dtype=int)
    if len(kept):
        np.testing.assert_allclose(drive.time - drive.time[0], TIME[kept] - TIME[kept[0]], atol=1e-6)
        whole = ~np.isin(np.arange(len(kept)), [30]) if habit.said else slice(None)
        np.testing.assert_allclose(drive.v[whole], V[kept][whole] / 3.6, rtol=1e-9)
        np.testing.assert_allclose(drive.T_mot[whole], T[kept][whole], rtol=1e-9)
        np.testing.assert_allclose(drive.T_mot, T[kept], atol=3.0)  # a straight line over one sample
    else:
        for values, expected in ((drive.v, V / 3.6), (drive.T_mot, T)):
            assert np.abs(np.interp(TIME[5:-5], drive.time, values) - expected[5:-5]).max() < (
                9.5 if habit.said == "" else 1e4
            )
    findings = [str(finding) for finding in of_channels(drive.channels.values())]
    assert len(findings) == bool(habit.said), findings
    assert all(habit.said in finding for finding in findings)


WORDS = """
    - -- --- NaN nan NAN -nan N/A n/a #N/A #NV #DIV/0! #VALUE! #WERT! null NULL (null) None nil 1.#QNAN -1.#IND ? ??? *
    **** #### . overflow #OVR timeout <missing> .. NAN(0x7f) ---.-- --,-- #CALC! #NAME? offline void invalid missing NA
    <NA> NaT \\N - nan(ind) -nan(ind) SNA err NOVALUE
"""


def test_what_loggers_write_where_there_is_no_value() -> None:
    words = [*WORDS.split(), "", " ", "k. A.", "Bad Input", "I/O Timeout", "no data", "not available"]
    assert [word for word in words if not is_missing(word)] == []
    assert not any(map(is_missing, ("0", "-1", "x", "fast", "1e3", "on")))


@together("name", ["a time for each channel", "a time of day for each channel"])
def test_a_channel_has_the_time_that_stands_before_it(tmp_path: Path, name: str) -> None:
    (path := tmp_path / "drive.csv").write_bytes(HABITS[name].content)
    channels = Channels(path).read("T_mot", "v")
    np.testing.assert_allclose(channels["v"].time, TIME, atol=1e-9)
    np.testing.assert_allclose(channels["T_mot"].time, TIME + 0.03, atol=1e-9)

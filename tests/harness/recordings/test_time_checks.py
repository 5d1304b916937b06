"""Which steps of time are gaps."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from driveline.harness.recordings import channels
from driveline.harness.recordings.channels import Channels, check_time
from driveline.harness.recordings.quantities import QUANTITIES
from driveline.harness.recordings.source import Column, RecordingError, Samples

JUST = 1e-6
"""How far from the longest step, as a share of it."""


def with_one_longer_step(steps: float, interval: float = 0.1) -> np.ndarray:
    """Eleven times, of which all but the last are an interval apart; that is so many intervals after the others."""
    return interval * np.append(np.arange(10.0), 9.0 + steps)


@pytest.mark.parametrize("gap", sorted({quantity.gap for quantity in QUANTITIES.values()}))
def test_the_longest_step_that_is_no_gap(gap: float) -> None:
    path = Path("measured.csv")
    check_time(path, with_one_longer_step(gap * (1.0 - JUST)), "line {}".format, gap)
    with pytest.raises(RecordingError, match=rf"line 10: gap of .* s after 0\.9 s; .*\({gap:g} times the median step"):
        check_time(path, with_one_longer_step(gap * (1.0 + JUST)), "line {}".format, gap)


@dataclass(frozen=True, eq=False)
class Logger:
    """A file whose channels have times of their own, or one for all."""

    times: Sequence[np.ndarray]
    columns: Sequence[Column]
    path: Path = Path("logged.mf4")
    headings: str = "logged.mf4"
    own_time: bool = True

    def read(self, places: Sequence[int]) -> list[Samples]:
        return [Samples(np.zeros_like(self.times[k]), self.times[k], "sample {}".format) for k in places]


MOTOR, WHEELS = QUANTITIES["omega_1"].gap, QUANTITIES["omega_wheel"].gap


@pytest.mark.parametrize(
    ("motor", "wheels", "together", "refused"),
    [
        (MOTOR - JUST, WHEELS - JUST, False, False),
        (MOTOR + JUST, 1.0, False, True),
        (1.0, WHEELS + JUST, False, True),
        (MOTOR - JUST, MOTOR - JUST, True, False),
        (MOTOR + JUST, MOTOR + JUST, True, True),
    ],
)
def test_messages_may_stay_away_for_longer_unless_they_share_the_time_of_a_sensor(
    monkeypatch: pytest.MonkeyPatch, motor: float, wheels: float, together: bool, refused: bool
) -> None:
    times = [with_one_longer_step(motor), with_one_longer_step(wheels)]
    names = [Column(f"{name} [rad/s]", name, "rad/s") for name in ("omega_1", "Wheel Speed")]
    logger = Logger([times[0]] * 2 if together else times, names)
    monkeypatch.setattr(channels, "opened", lambda *_: logger)
    if refused:
        with pytest.raises(RecordingError, match="sample 10: gap of"):
            Channels(logger.path).read("omega_1", "omega_wheel")
    else:
        assert Channels(logger.path).read("omega_1", "omega_wheel").keys() == {"omega_1", "omega_wheel"}

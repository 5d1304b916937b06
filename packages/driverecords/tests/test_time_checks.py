"""Which steps of time are gaps."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path

import numpy as np
import pytest

from driverecords import channels
from driverecords.channels import Channels
from driverecords.quantities import QUANTITIES
from driverecords.source import Column, RecordingError, Samples
from driverecords.time_base import Break, clean_pieces, spread_equal_times, time_breaks

JUST = 1e-6
"""How far from the longest step, as a share of it."""


def with_one_longer_step(steps: float, interval: float = 0.1) -> np.ndarray:
    """Eleven times, of which all but the last are an interval apart; that is so many intervals after the others."""
    return interval * np.append(np.arange(10.0), 9.0 + steps)


@pytest.mark.parametrize("gap", sorted({quantity.gap for quantity in QUANTITIES.values()} - {inf}))
def test_the_longest_step_that_is_no_gap(gap: float) -> None:
    path = Path("measured.csv")
    assert time_breaks(path, with_one_longer_step(gap * (1.0 - JUST)), "line {}".format, gap) == []
    (gap_found,) = time_breaks(path, with_one_longer_step(gap * (1.0 + JUST)), "line {}".format, gap)
    assert re.search(rf"line 10: gap of .* s after 0\.9 s; .*\({gap:g} times the median step", gap_found.problem)
    assert (gap_found.end, gap_found.begin) == pytest.approx((0.9, 0.9 + 0.1 * gap), rel=1e-5)


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


@pytest.mark.parametrize(
    ("breaks", "pieces"),
    [
        ([], [(0.0, 10.0)]),
        ([(3.0, 4.0)], [(0.0, 3.0), (4.0, 10.0)]),
        ([(7.0, 9.0), (2.0, 2.5)], [(0.0, 2.0), (2.5, 7.0), (9.0, 10.0)]),
        ([(2.0, 8.0), (3.0, 4.0)], [(0.0, 2.0), (8.0, 10.0)]),
        ([(8.0, inf)], [(0.0, 8.0)]),
        ([(-inf, 1.0)], [(1.0, 10.0)]),
        ([(-inf, inf)], []),
    ],
)
def test_clean_pieces_are_those_between_the_breaks(
    breaks: list[tuple[float, float]], pieces: list[tuple[float, float]]
) -> None:
    assert clean_pieces(0.0, 10.0, [Break(*times, "") for times in breaks]) == pieces


@pytest.mark.parametrize("resolution", [0.2, 0.25, 0.5])
def test_equal_times_at_the_resolution_of_the_clock_are_those_of_a_steady_one(resolution: float) -> None:
    time = 5.0 + 0.1 * np.arange(300)
    np.testing.assert_allclose(spread_equal_times(np.floor(time / resolution + 1e-9) * resolution), time, atol=0.02)


def test_equal_times_of_a_clock_that_is_not_steady_are_spread_up_to_the_next() -> None:
    assert spread_equal_times(np.array([0.0, 0.0, 1.0, 5.0, 5.0, 5.0, 5.0, 6.0])).tolist() == [
        0,
        0.5,
        1,
        5,
        5.25,
        5.5,
        5.75,
        6,
    ]


def test_one_pair_of_equal_times_among_many_is_left() -> None:
    time = np.sort(np.append(0.1 * np.arange(200), 5.0))
    assert spread_equal_times(time) is time

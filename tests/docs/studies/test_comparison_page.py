"""The controllers side by side: what is best is bold, and who beats ours pays a price that is named."""

from collections.abc import Mapping
from math import nan

import pytest

from docs.studies.comparison_page import DEARER, KEYS, MARK, OURS, Key, page
from driveline.harness.loop.places import COMPARATORS, PLANTS
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics


def metrics(**values: float) -> Metrics:
    """All 1 but these."""
    return Metrics(**{metric.name: 1.0 for metric in declared(Metrics)} | values)  # type: ignore[arg-type]


def everywhere(usual: Metrics) -> dict[Key, Metrics]:
    return dict.fromkeys(KEYS, usual)


def side_by_side(**others: Mapping[str, float]) -> str:
    """The page where all metrics are 1 but those of others, in tipin15 on the first plant."""
    changed = {Key(PLANTS[0], "tipin15", name): metrics(**values) for name, values in others.items()}
    return page(everywhere(metrics()) | changed)


def rows(text: str, heading: str) -> str:
    """The row of tipin15 in the first table of a metric."""
    return next(line for line in text.partition(f"| {heading}")[2].splitlines() if line.startswith("| tipin15 |"))


def test_the_best_that_a_car_can_have_is_bold() -> None:
    others = [name for name in COMPARATORS if name != MARK]
    text = side_by_side(
        **{OURS: {"overshoot": 0.1}, MARK: {"overshoot": 0.01}}, **{n: {"overshoot": 0.2} for n in others}
    )
    cells = ["**10**", *("1" if name == MARK else "20" for name in COMPARATORS)]
    assert rows(text, "overshoot") == f"| tipin15 | {' | '.join(cells)} |"


def test_who_beats_ours_is_named_with_the_price() -> None:
    text = side_by_side(SpeedWashout={"overshoot": -0.5, "withheld_time": 2.0, "impact_speed": 1.1, "jerk_rms": 9.0})
    message = (
        "- tipin15, `SpeedWashout`: overshoot 50 % instead of 100; price: torque withheld 2000.0 ms instead of 1000.0"
    )
    assert message in text
    assert "impact speed 1.1" not in text
    assert text.count("\n- nowhere") == 1, "the other plant"


def test_what_is_as_good_as_the_digits_that_are_shown_beats_nobody() -> None:
    assert side_by_side(SpeedWashout={"overshoot": 0.999}).count("\n- nowhere") == len(PLANTS)


def test_the_mark_beats_nobody() -> None:
    assert side_by_side(**{MARK: {"overshoot": 0.1}}).count("\n- nowhere") == len(PLANTS)


@pytest.mark.parametrize("value", [nan, 0.0])
def test_a_metric_that_ours_has_not_has_no_row(value: float) -> None:
    table = page(everywhere(metrics(overshoot=value))).partition("| overshoot")[2].partition("\n\n")[0]
    assert ("| tipin15 |" in table) == (value == 0.0)


@pytest.mark.parametrize(("share", "is_dearer"), [(0.999, False), (1.001, True)])
def test_a_price_is_what_is_dearer_by_a_share_of_ours(share: float, is_dearer: bool) -> None:
    """However large ours is."""
    for size in (0.5, 2.0):
        ours = {"overshoot": 1.0, "withheld_time": size}
        its = {"overshoot": 0.5, "withheld_time": share * DEARER * size}
        text = side_by_side(**{OURS: ours, "SpeedWashout": its})
        (line,) = (line for line in text.splitlines() if line.startswith("- tipin15, `SpeedWashout`"))
        assert ("torque withheld" in line) == is_dearer

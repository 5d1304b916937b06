"""The page says what was drawn."""

from types import SimpleNamespace
from typing import Any

import pytest

from driveline.harness.design.uncertainty_box import LOSS, SHORTEST, SPREAD
from driveline.harness.studies.robustness import robustness_report as pages


def test_the_page_says_how_much_is_lost_and_late_in_the_units_of_its_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pages, "_of_plant", lambda *_: "")
    monkeypatch.setattr(pages, "_worst", lambda *_: [])
    summary: Any = SimpleNamespace(outcomes=[None] * 300, controller="ours", plant="Car", manoeuvre="launch")
    text = pages.page([summary], 1, "", [])
    assert (LOSS, SPREAD, SHORTEST) == (0.1, 0.01, 0.001)
    assert "never less than 1 ms; 10 % of the messages are lost" in " ".join(text.split())
    assert "figures/worst_Car_launch.png" not in text
    assert "figures/worst_Car_launch.png" in pages.page([summary], 1, "", [summary])

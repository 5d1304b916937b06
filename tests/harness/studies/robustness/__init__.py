"""Outcomes that no run has made."""

from typing import Any

from driveline.harness.studies.robustness.outcome import METRICS, Case, Outcome

GOOD = {metric.name: 0.0 for metric in METRICS}


def outcome(
    number: Any = 1, controller: Any = "DampingController", manoeuvre: Any = "tipin15", **measured: Any
) -> Outcome:
    """A good run, but for what was measured."""
    return Outcome(Case("TwoMassDriveline", controller, number, manoeuvre), GOOD | measured)

"""Outcomes that no run has made."""

from harness.robustness.outcome import METRICS, Case, Outcome

GOOD = {metric.name: 0.0 for metric in METRICS}


def outcome(number: int = 1, controller: str = "DampingController", manoeuvre: str = "tipin15", **measured) -> Outcome:
    """A good run, but for what was measured."""
    return Outcome(Case("TwoMassDriveline", controller, number, manoeuvre), GOOD | measured)

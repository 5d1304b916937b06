"""What a campaign says of each controller: shares of its runs, and what half and 95 % of them do not exceed."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import isinf
from typing import Any

import numpy as np

from ...metrics.declaration import Column
from .outcome import METRICS, ROBUSTNESS_MANOEUVRES, SHOWN, Outcome

LEVELS = (0.5, 0.95)


@dataclass(frozen=True)
class Summary:
    """The runs with a plant and a controller, of a manoeuvre."""

    plant: str
    controller: str
    manoeuvre: str
    outcomes: Sequence[Outcome]

    def share(self, verdict: str) -> float:
        """Of the runs with a verdict, see `harness.studies.robustness.outcome.Outcome`."""
        return float(np.mean([getattr(outcome, verdict) for outcome in self.outcomes]))

    def level(self, metric: str, share: float) -> float:
        """The magnitude of a metric that this share of the runs does not exceed; infinite if so many have no value."""
        values = [outcome.magnitude(metric) for outcome in self.outcomes]
        return float(np.quantile(values, share, method="inverted_cdf"))

    @property
    def worst(self) -> Outcome:
        """The run that settles last; of those that never do the one that swings most in the end."""
        return max(self.outcomes, key=lambda each: (each.magnitude("settling_time"), each.magnitude("end_swing")))

    @property
    def record(self) -> dict[str, Any]:
        """For tools; None where a level has no value."""
        given: dict[str, Any] = {"plant": self.plant, "controller": self.controller, "manoeuvre": self.manoeuvre}
        given |= {"runs": len(self.outcomes), "bounded_and_quiet": self.share("stable"), "good": self.share("good")}
        for metric in METRICS:
            for level in LEVELS:
                value = self.level(metric.name, level)
                given[f"{metric.key}_{level * 100:g}_percent"] = None if isinf(value) else value
        return given | {"worst": self.worst.case.number}


def summaries(outcomes: Iterable[Outcome]) -> list[Summary]:
    """By plants, manoeuvres and, in these, controllers."""
    found: dict[tuple[str, str, str], list[Outcome]] = {}
    for outcome in outcomes:
        case = outcome.case
        found.setdefault((case.plant, case.controller, case.manoeuvre), []).append(outcome)
    plants = list(dict.fromkeys(plant for plant, _, _ in found))
    order = sorted(found, key=lambda key: (plants.index(key[0]), ROBUSTNESS_MANOEUVRES.index(key[2])))
    return [Summary(*key, found[key]) for key in order]


def cells(summary: Summary, metrics: Iterable[str] = SHOWN) -> list[str]:
    """The shares, and of each metric what half and 95 % of the runs do not exceed."""
    shares = (percent(summary.share(verdict)) for verdict in ("stable", "good"))
    return [*shares, *(_levels(summary, name, SHOWN[name]) for name in metrics)]


def _levels(summary: Summary, name: str, column: Column) -> str:
    return " / ".join(level_text(summary.level(name, level), column) for level in LEVELS)


def level_text(value: float, column: Column) -> str:
    """A level; a dash where more runs have no value."""
    return "-" if isinf(value) else f"{value * column.factor:.{column.decimals}f}"


def percent(share: float) -> str:
    """A share; 100 and 0 only if it is all or nothing."""
    return f"{100.0 * share if share in (0.0, 1.0) else min(max(100.0 * share, 0.1), 99.9):.3g}"


def goal(summaries: Sequence[Summary], plant: str, controller: str) -> str:
    """What is bounded and quiet, in all manoeuvres; 95 % of the settling time of the tip-in and of the launch."""
    its = {each.manoeuvre: each for each in summaries if (each.plant, each.controller) == (plant, controller)}
    share = np.mean([each.share("stable") for each in its.values()])
    times = (its[name].level("settling_time", 0.95) for name in ("tipin15", "launch"))
    return f"{percent(float(share))} %; {' / '.join('-' if isinf(t) else f'{t:.2f}' for t in times)} s"

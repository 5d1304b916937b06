"""A run of the Monte-Carlo, what came of it, and when it is bounded, quiet and good."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, nan
from typing import NamedTuple

from ...manoeuvres.catalogue import MANOEUVRES
from ...metrics.declaration import Column, Metric, declared
from ...metrics.oscillation import SETTLED
from ...metrics.run_metrics import Metrics

ROBUSTNESS_MANOEUVRES = ("tipin15", "tipout", "launch")

LARGEST_PEAK = 2.0
"""Over the largest torque of the motor; so far swings a spring without damping on which that torque is put at once."""

SETTLES, OVERSHOOTS, WITHHELD = 0.4, 0.4, 0.03
"""The most that a good run has: settling time in s, three swings of the drive train; overshoot; torque withheld in s of
the step. The specification asks for a share of good runs and does not say what good is: this is our definition."""

VERDICTS = {
    "bounded": "all signals are finite, and the gear torque is never beyond "
    f"{LARGEST_PEAK:g} times the largest torque of the motor",
    "quiet": f"in the last second the gear torque swings by no more than {100 * SETTLED:g} % of the step, "
    "which is what counts as settled",
    "good": f"bounded and quiet, settled within {SETTLES:g} s, overshoot of at most {100 * OVERSHOOTS:g} %, "
    f"and no more than {WITHHELD * 1e3:g} ms of the step withheld from the driver",
}
"""Of a run, in words."""

PEAK = Metric("1", "largest magnitude of the gear torque over the largest torque of the motor", name="gear_torque_peak")
METRICS = (*declared(Metrics), PEAK)
"""What is kept of each run."""

SHOWN: Mapping[str, Column] = {
    metric.name: metric.column
    for metric in METRICS
    if metric.column and metric.name not in ("damping_ratio", "jerk_rms", "impact_speed_90", "crossing_time")
} | {"jerk_rms_to_50_Hz": Column("jerk\nto 50 Hz", "m/s3", 1.0, 1)}
"""The metrics of the tables; the damping ratio is too rough for shares of runs."""


class Case(NamedTuple):
    """A run: plant and controller by name, the number of the draw, the manoeuvre."""

    plant: str
    controller: str
    number: int
    manoeuvre: str

    def __str__(self) -> str:
        return f"{self.number}, {self.manoeuvre} on {self.plant} with {self.controller}"


@dataclass(frozen=True)
class Outcome:
    """A run that was made.

    Attributes:
        measured: its METRICS by name; NaN where one has no value.
        reason: why an FMU ended it, or nothing.
        share: of the demands of the catalogue that the car was asked for.
    """

    case: Case
    measured: Mapping[str, float]
    reason: str = ""
    share: float = 1.0

    def magnitude(self, metric: str) -> float:
        """Of a metric, the larger the worse; what has no value is the worst."""
        value = abs(self.measured[metric])
        return inf if value != value else value

    @property
    def bounded(self) -> bool:
        return self.magnitude(PEAK.name) <= LARGEST_PEAK

    @property
    def quiet(self) -> bool:
        step = self.share * abs(MANOEUVRES[self.case.manoeuvre].dT or nan)
        return self.magnitude("end_swing") <= SETTLED * step

    @property
    def stable(self) -> bool:
        """Bounded and quiet."""
        return self.bounded and self.quiet

    @property
    def good(self) -> bool:
        return (
            self.stable
            and self.magnitude("settling_time") <= SETTLES
            and self.magnitude("overshoot") <= OVERSHOOTS
            and self.measured["withheld_time"] <= WITHHELD
        )

"""What the estimate of the gear torque is worth, from runs of the loop: its error, and wrong modes of contact."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from ..loop import roles
from .declaration import Absent, Column, Metric, measured
from .evaluate import at_samples
from .notebook_table import NotebookTable


@dataclass(frozen=True)
class EstimateMetrics(NotebookTable):
    """Of T_gear_hat, compared with the true gear torque at the samples of the controller."""

    bias: Annotated[float, Metric("1", "mean error in contact, over the gear torque", Column("bias", "%", 1e2, 1))]
    error_rms: Annotated[float, Metric("N.m", "rms of the error in contact", Column("error,\nrms", "N.m", 1.0, 2))]
    wrong_mode: Annotated[
        float,
        Metric(
            "1",
            "share of the time in which the estimate has the teeth elsewhere than they are: flank, gap, other flank",
            Column("wrong\nmode", "%", 1e2, 1),
        ),
    ]
    wrong_gap: Annotated[
        float, Metric("1", "the same, of the time in the gap", Column("of the time\nin the gap", "%", 1e2, 0))
    ]
    absent: Mapping[str, str] = field(default_factory=dict)
    """Why metrics have no value, by their names."""


def estimate_metrics(results: np.ndarray) -> EstimateMetrics:
    """What the estimate in a run of the loop is worth; NaN without a gap, or where nothing is estimated."""
    sampled = at_samples(results)
    told = {roles.GEAR_TORQUE_ESTIMATE, roles.TWIST_ESTIMATE} <= set(results.dtype.names or ())
    true = sampled[roles.GEAR_TORQUE]
    estimated = sampled[roles.GEAR_TORQUE_ESTIMATE] if told else true
    contact, wrong = true != 0.0, np.sign(true) != np.sign(estimated)
    error = (estimated - true)[contact]

    def of_the_gap() -> float:
        if contact.all():
            raise Absent("the teeth are never in the gap")
        return float(wrong[~contact].mean())

    computed = {
        "bias": lambda: float(np.dot(error, true[contact]) / np.dot(true, true)),
        "error_rms": lambda: float(np.sqrt(np.mean(error**2))),
        "wrong_mode": lambda: float(wrong.mean()),
        "wrong_gap": of_the_gap,
    }
    nothing = "the controller estimates no twist" if not (told and sampled[roles.TWIST_ESTIMATE].any()) else None
    return EstimateMetrics(**measured(computed, none_because=nothing))

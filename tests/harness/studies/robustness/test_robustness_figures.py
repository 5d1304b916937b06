"""The distributions of a campaign: a panel for each metric, with a curve for each controller."""

import numpy as np
import pytest

from driveline.harness.studies.robustness.outcome import SHOWN
from driveline.harness.studies.robustness.robustness_figures import DRAWN, distributions
from driveline.harness.studies.robustness.summary import summaries
from driveline.harness.views.panels import Curve
from tests.harness.studies.robustness.outcomes import outcome

CONTROLLERS = "DampingController", "NoDamping"


def test_each_metric_has_a_panel_with_the_shares_of_all_controllers() -> None:
    outcomes = [outcome(k, name, settling_time=0.1 * k) for name in CONTROLLERS for k in (2, 1, 4)]
    panels = distributions(summaries(outcomes), "tipin15")
    assert [panel.heading for panel in panels] == ["tipin15", *[""] * (len(DRAWN) - 1)]
    for panel, metric in zip(panels, DRAWN, strict=True):
        assert panel.x is not None
        assert SHOWN[metric].unit.replace("m/s3", "m/s³") in panel.x.label
        assert panel.ticks[95.0] == "95"
        curves = [part for part in panel.parts if isinstance(part, Curve)]
        assert [curve.label for curve in curves] == list(CONTROLLERS)
        np.testing.assert_allclose(curves[0].y, [0.0, 100.0 / 3.0, 200.0 / 3.0, 100.0])
    settling = panels[list(DRAWN).index("settling_time")].parts[0]
    assert isinstance(settling, Curve)
    assert settling.x[1:] == pytest.approx(np.array([0.1, 0.2, 0.4]) * SHOWN["settling_time"].factor)

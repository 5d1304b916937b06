"""The figures of linear loops have as many lines as there are loops."""

from math import nan
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from driveline.harness.studies.margins.linear_figures import bode
from driveline.harness.views.panels import Curve, Points

MARKED = "delay margin"


@pytest.mark.parametrize("count", [1, 3])
def test_each_loop_has_its_magnitude_and_phase(count: int) -> None:
    """L = 2/(1 + i f/10 Hz): 6 dB at low frequencies, 90 degrees late at high ones, and 1 at sqrt(3) 10 Hz."""
    loop = SimpleNamespace(gain=lambda f: 2.0 / (1.0 + 0.1j * f))
    margin = SimpleNamespace(gain_frequency=nan, delay_frequency=10.0 * np.sqrt(3.0))
    loops: Any = {f"loop {k}": (loop, margin) for k in range(count)}
    drawn = [panel for (panel,) in bode(loops, "loops").rows]
    for panel, ends, at in zip(drawn, ((6.0, -21.9), (-3.0, -87.7)), (0.0, -60.0), strict=True):
        curves = [part for part in panel.parts if isinstance(part, Curve)]
        points = [part for part in panel.parts if isinstance(part, Points)]
        assert [curve.label for curve in curves] == list(loops)
        assert [point.label for point in points] == [MARKED if panel is drawn[0] else "", *[""] * (count - 1)]
        assert len({curve.color for curve in curves}) == len(points) == count
        for curve, point in zip(curves, points, strict=True):
            assert (curve.y[0], curve.y[-1]) == pytest.approx(ends, abs=0.2)
            assert point.y == pytest.approx(at, abs=0.1)

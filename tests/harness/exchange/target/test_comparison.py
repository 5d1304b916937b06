"""What counts as the same torque in single and in double precision. The programs are stand-ins."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from driveline.fmus.target.link import Answer
from driveline.harness.exchange.target.comparison import compare
from driveline.harness.exchange.target.controllers import Programs
from driveline.harness.exchange.target.offline_cases import Case
from tests.together import together

CASE = Case("two samples", ("T_driver",), np.zeros((2, 1)), None, False)


class StandIn:
    """A program that demands the same torque in each sample."""

    def __init__(self, T_ref: float) -> None:
        self.answer = Answer((T_ref, 0.0), (0.0,), b"", 1, 2)

    def __enter__(self) -> "StandIn":
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def start(self, u: Any) -> Answer:
        return self.answer

    update = start


@together("T_ref, distance, margin", [(100.0, 0.011, 1.0), (-100.0, 0.0055, 0.5), (0.0, 1e-3, 1.0)])
def test_torques_may_differ_by_a_millinewton_metre_and_a_ten_thousandth(
    T_ref: float, distance: float, margin: float
) -> None:
    target: Any = StandIn(T_ref + distance)
    double: Any = StandIn(T_ref)
    programs = Programs(lambda: target, lambda: target, lambda: double, Path(), "")
    found = compare(programs, CASE, ("T_ref", "T_gear_hat"))
    assert found.margin == pytest.approx(margin)
    assert found.T_ref == pytest.approx(distance)
    assert (found.samples, found.differing, found.instructions, found.stack) == (2, 0, (1.0, 1), 2)

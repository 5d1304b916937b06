"""How good a model is, judged by data: nearly all of a drive of its own, the less the further ahead."""

import numpy as np
import pytest

from driveline.harness.identification.quality import judged
from tests.harness.identification.simulated import NOISE, P, simulated


def test_of_a_drive_of_its_own_the_model_predicts_nearly_all_and_less_the_further_ahead() -> None:
    drive = simulated(seed=4)
    right = judged(drive, P, NOISE, 1.0, 700)
    assert right.size == pytest.approx(1.0, abs=0.1)
    assert abs(right.correlation) < 0.25
    noise = 100.0 * (1.0 - NOISE.omega_1 / np.std(drive.omega_1[700:]))
    assert noise + 1.0 > right.one_step > right.predicted > 60.0
    wrong = judged(drive, P._replace(C=1.5 * P.C), NOISE, 1.0, 700)
    for name in ("simulated", "one_step", "predicted"):
        assert getattr(wrong, name) < getattr(right, name), name
    assert wrong.size > 2.0 * right.size

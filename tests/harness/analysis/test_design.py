"""The gains are those of the design, and the design is what it says."""

import numpy as np
import pytest

from harness.analysis.design import PLANT, WEIGHTS, damping_gain, design, process_noise, stored, transition
from harness.commands.design import STORED
from models.controller.torque_estimator import Estimate, corrected_by_motor_speed, integrated
from models.damping_controller import BLOCK

STORED_DIGITS = 1e-5
"""Six digits are stored."""


def test_the_stored_gains_are_those_of_the_design() -> None:
    assert STORED.read_text() == stored(design()), "run `driveline design`"


def test_the_controller_takes_its_defaults_from_the_design() -> None:
    defaults = BLOCK.Parameters()._asdict()
    for name, value in design().items():
        assert defaults[name] == pytest.approx(value, rel=STORED_DIGITS), name


def test_the_model_of_the_design_is_that_of_the_plant() -> None:
    p = BLOCK.Parameters()
    assert (p.J_1, p.J_2, p.C, p.phi_B) == (PLANT.J_1, PLANT.J_2, PLANT.C, PLANT.phi_B)


def test_the_estimator_with_its_gains_is_stable_in_contact() -> None:
    p = BLOCK.Parameters()
    contact = Estimate(0.0, 0.0, 2.0 * p.phi_B, 0.0)
    columns = []
    for row in np.eye(4):
        e = integrated(Estimate(*(np.array(contact) + 1e-3 * row).tolist()), 0.0, 0.002, p)
        still = integrated(contact, 0.0, 0.002, p)
        columns.append(
            (
                np.array(corrected_by_motor_speed(e, 0.0, 0.0, p))
                - np.array(corrected_by_motor_speed(still, 0.0, 0.0, p))
            )
            / 1e-3
        )
    assert np.abs(np.linalg.eigvals(np.array(columns).T)).max() < 1.0


def test_more_weight_on_the_relative_speed_damps_more() -> None:
    from dataclasses import replace

    gains = [damping_gain(replace(WEIGHTS, damping=weight)) for weight in (1.0, 2.0, 4.0)]
    assert gains == sorted(gains)
    assert gains[0] == pytest.approx(1.0, rel=0.1), "the cheap-control limit of a lightly damped oscillator"


def test_the_load_torque_is_a_random_walk_in_the_design() -> None:
    p = BLOCK.Parameters()
    A = transition(p)
    assert A[3].tolist() == [0.0, 0.0, 0.0, 1.0]
    assert np.all(np.linalg.eigvalsh(process_noise(WEIGHTS)) > 0.0)

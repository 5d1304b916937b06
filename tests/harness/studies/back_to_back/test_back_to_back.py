"""The functions of a block, its FMU in Python and its native FMU give the same, alone and in the loop."""

from dataclasses import replace

import numpy as np
import pytest

from driveline.fmus.catalogue import FMUS
from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.studies.back_to_back.back_to_back import (
    Differences,
    LoopRow,
    by_functions,
    compare_block,
    compare_loop,
    difference,
    random_inputs,
)
from driveline.harness.studies.back_to_back.back_to_back_page import page
from driveline.models import two_mass_driveline
from tests.slow import slow

EXACT = 1e-12
"""Where no flank is crossed."""

AFTER_FLANKS = 1e-9
"""Within 10 s: each crossing is located anew and moves what rounding has made of it."""

STEPS = 2000


def short(name: str) -> Manoeuvre:
    """The first 1.5 s: through the backlash, or away from standstill."""
    return replace(MANOEUVRES[name], duration=1.5)


@pytest.mark.parametrize("name", slow(FMUS, but=FMUS.keys() - {"ValidationVehicle"}))
def test_random_inputs_give_the_same_in_functions_and_both_builds(both_built, name):
    allowed = AFTER_FLANKS if name in PLANTS else EXACT
    for seed in (1, 2):
        found = compare_block(name, random_inputs(FMUS[name].block, STEPS, seed), both_built)
        assert max(found) <= allowed


EFFECTS = {
    "MotorTorqueLoop": {"t_dead": 5e-3, "dT_max": 8000.0, "omega_base": 60.0},
    "ValidationVehicle": {"g_muL": 0.1},
}
"""That are off by default."""


@pytest.mark.parametrize("name", slow(EFFECTS, but=("MotorTorqueLoop",)))
@pytest.mark.slow
def test_effects_that_are_off_by_default_are_the_same_in_functions_and_both_builds(both_built, name):
    random = random_inputs(FMUS[name].block, STEPS)
    given = random._replace(parameters={**random.parameters, **EFFECTS[name]})
    assert max(compare_block(name, given, both_built)) <= AFTER_FLANKS


@pytest.mark.parametrize("plant", slow(PLANTS, but=("TwoMassDriveline",)))
@pytest.mark.parametrize("manoeuvre", slow(["tipin15", "hill_hold"], but=["hill_hold"]))
def test_the_loop_does_not_see_which_build_a_block_is_of(both_built, plant, manoeuvre):
    found = compare_loop(plant, short(manoeuvre), both_built)
    assert set(found) == {"motor", "controller", "can", "plant"}
    for instance, differences in found.items():
        assert max(differences) <= AFTER_FLANKS, instance


def test_a_difference_would_be_seen():
    one = np.array([(0.0, 1.0), (1e-3, 200.0)], [("time", float), ("T_gear", float)])
    other = one.copy()
    assert difference(one, other) == 0.0
    one["T_gear"][0] += 2e-7
    assert difference(one, other) == pytest.approx(1e-9)
    one["T_gear"][0] = np.nan
    assert difference(one, other) == np.inf


def test_random_inputs_cross_the_flanks():
    block = two_mass_driveline.BLOCK
    T_gear = by_functions(block, random_inputs(block, STEPS))["T_gear"]
    assert T_gear.min() < 0.0 < T_gear.max()
    assert np.any(T_gear == 0.0)


def test_the_page_says_what_was_measured():
    row = LoopRow("TwoMassDriveline", "launch", {"motor": Differences(0.0, 0.0, 3e-13)})
    text = page({"MotorTorqueLoop": Differences(2e-16, 0.0)}, 10, [row])
    assert "| MotorTorqueLoop | 2e-16 | 0 |" in text
    assert "| TwoMassDriveline | launch | 0 / 0 / 3e-13 |" in text

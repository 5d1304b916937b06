"""The functions of a block, its FMU in Python and its native FMU give the same, alone and in the loop."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fmutesting.slow import slow

from driveline.fmus.catalogue import FMUS
from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES, USUAL_MANOEUVRES
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.models import two_mass_driveline
from tests.back_to_back import by_functions, compare_block, compare_loop, difference, random_inputs

EXACT = 1e-12
"""Where no flank is crossed."""

AFTER_FLANKS = 1e-9
"""Within 10 s: each crossing is located anew and moves what rounding has made of it."""

STEPS = 2000


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


@pytest.mark.parametrize("name", EFFECTS)
@pytest.mark.slow
def test_effects_that_are_off_by_default_are_the_same_in_functions_and_both_builds(both_built, name):
    random = random_inputs(FMUS[name].block, STEPS)
    given = random._replace(parameters={**random.parameters, **EFFECTS[name]})
    assert max(compare_block(name, given, both_built)) <= AFTER_FLANKS


def builds_are_alike(plant: str, manoeuvre: Manoeuvre, folder: Path) -> None:
    """In the first 1.5 s: through the backlash, or away from standstill."""
    found = compare_loop(plant, replace(manoeuvre, duration=1.5), folder)
    assert set(found) == {"motor", "controller", "can", "plant"}
    for instance, differences in found.items():
        assert max(differences) <= AFTER_FLANKS, (manoeuvre.name, instance)


def test_the_loop_does_not_see_which_build_a_block_is_of(both_built):
    builds_are_alike(PLANTS[0], MANOEUVRES["tipin15"], both_built)


@pytest.mark.parametrize("plant", PLANTS)
@pytest.mark.slow
def test_nor_does_it_in_any_manoeuvre(both_built, plant):
    for manoeuvre in USUAL_MANOEUVRES:
        builds_are_alike(plant, manoeuvre, both_built)


def test_a_difference_would_be_seen_and_random_inputs_cross_the_flanks():
    one = np.array([(0.0, 1.0), (1e-3, 200.0)], [("time", float), ("T_gear", float)])
    other = one.copy()
    assert difference(one, other) == 0.0
    one["T_gear"][0] += 2e-7
    assert difference(one, other) == pytest.approx(1e-9)
    one["T_gear"][0] = np.nan
    assert difference(one, other) == np.inf
    block = two_mass_driveline.BLOCK
    T_gear = by_functions(block, random_inputs(block, STEPS))["T_gear"]
    assert T_gear.min() < 0.0 < T_gear.max()
    assert np.any(T_gear == 0.0)

"""A campaign gives the same whatever the number of processes, and says what is not clean."""

from collections import Counter

import numpy as np
import pytest

from harness.cosimulation.runs import run
from harness.cosimulation.system import loop
from harness.faults.bench import Bench, with_faults
from harness.faults.campaign import campaign
from harness.faults.cases import SITUATIONS, Case, Fault, case
from harness.faults.catalogue import KINDS, LOCK, SPIN
from harness.faults.page import page
from harness.simulate import signals, start

PLANTS = ("TwoMassDriveline", "ValidationVehicle")


def test_a_case_follows_from_seed_and_number_alone():
    assert case(7, 1, PLANTS) == case(7, 1, PLANTS)
    assert case(7, 2, PLANTS).faults != case(7, 1, PLANTS).faults


def test_single_faults_go_through_all_kinds_and_situations_on_both_plants():
    everything = 2 * len(PLANTS) * len(KINDS) * len(SITUATIONS)
    singles = [each for n in range(1, everything + 1) if len((each := case(n, 1, PLANTS)).faults) == 1]
    cells = Counter((each.plant, each.situation, each.faults[0].name) for each in singles)
    assert set(cells.values()) == {1}
    assert len(cells) == everything / 2


def test_half_of_the_cases_are_pairs_of_different_kinds():
    pairs = [each for n in range(1, 201) if len((each := case(n, 1, PLANTS)).faults) == 2]
    assert len(pairs) == 100
    assert all(first.name != second.name for first, second in (each.faults for each in pairs))


@pytest.mark.parametrize("plant", PLANTS)
def test_the_injector_without_a_fault_changes_nothing(injector, settings, plant):
    manoeuvre = SITUATIONS["gap"].manoeuvre
    plain = loop(plant, settings[plant]["folder"], "native")
    direct, through = (
        run(system, 1.3, inputs=signals(manoeuvre), parameters=start(manoeuvre))
        for system in (plain, with_faults(plain, injector))
    )
    assert all(np.array_equal(direct[name], through[name]) for name in direct.dtype.names or ())


def test_a_campaign_does_not_depend_on_the_number_of_processes(injector, settings):
    one, two = (campaign(range(1, 9), 3, injector, settings, workers) for workers in (1, 2))
    assert [outcome.record for outcome in one] == [outcome.record for outcome in two]
    assert page(one, "") == page(two, "")


@pytest.mark.parametrize(
    ("plant", "least", "most"), [("TwoMassDriveline", 0.25, 1.1), ("ValidationVehicle", 0.05, 1.5)]
)
def test_on_ice_the_wheels_lock_and_spin(injector, settings, plant, least, most):
    bench = Bench(injector, settings)

    def speed_of_the_wheels(kind, size):
        """Over that of rolling."""
        fault = Fault(kind, 1.0, 1.5, size, 1.0)
        undamped = bench.runs(Case(1, plant, "coasting", (fault,), 1)).undamped
        return undamped["plant.omega_2"] / (undamped["plant.v"] * 9.0 / 0.29)

    assert speed_of_the_wheels(LOCK, 4000.0).min() < least
    assert speed_of_the_wheels(SPIN, 80.0).max() > most

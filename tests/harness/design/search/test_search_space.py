"""What is searched follows from the declaration of the controllers' parameters."""

from typing import Any

import pytest

from driveline.fmus.building.parameter_files import of_plants, read_vehicle
from driveline.fmus.catalogue import EVERY
from driveline.harness.base.errors import DrivelineError
from driveline.harness.design.design import AUTHORITY, design, literal_observer
from driveline.harness.design.design_weights import records
from driveline.harness.design.search.search_space import Searched, space
from driveline.harness.loop.places import PLACES
from driveline.models.block.declaration import Real, variables
from tests import ROOT

OURS = "DampingController"
TUNED = [name for name in PLACES["controller"] if name != "NoDamping"]
VAN = read_vehicle(ROOT / "examples" / "cars" / "van.toml")


def declared(controller: str) -> dict[str, Any]:
    return {v.name: v for v in variables(EVERY[controller].block.Parameters)}


@pytest.mark.parametrize("controller", TUNED)
def test_what_is_declared_with_a_range_is_searched_from_its_start(controller: str) -> None:
    found = {each.name: each for each in space(controller, {}).searched}
    ranges = {
        name: v.declaration.search
        for name, v in declared(controller).items()
        if isinstance(v.declaration, Real) and v.declaration.search
    }
    assert found.keys() == ranges.keys()
    for name, each in found.items():
        assert (each.low, each.high) == pytest.approx(ranges[name])
        assert each.start == pytest.approx(declared(controller)[name].start, rel=1e-5)


@pytest.mark.parametrize("controller", TUNED)
def test_a_range_lies_within_the_bounds_and_around_the_start(controller: str) -> None:
    for name, v in declared(controller).items():
        if isinstance(v.declaration, Real) and v.declaration.search:
            low, high = v.declaration.search
            assert v.declaration.minimum <= low < v.start < high <= v.declaration.maximum, name
            assert name not in of_plants()


def test_our_law_is_searched_and_what_is_computed_is_not() -> None:
    found = space(OURS, {})
    assert {each.name for each in found.searched} >= {"k_d", "k_T", "omega_w", "T_gap"}
    assert found.computed.keys() == design().keys() - {each.name for each in found.searched}
    assert {"lambda_v", "L_phi", "Ls_phi", "L_can_phi"} <= found.computed.keys()


def test_the_start_is_what_the_formulas_make_of_the_car() -> None:
    designed = design(VAN)
    found = space(OURS, VAN)
    assert found.parameters(found.start) == pytest.approx(designed, rel=1e-5)
    k_d = next(each for each in found.searched if each.name == "k_d")
    assert k_d.high / k_d.start == pytest.approx(10.0 / design()["k_d"], rel=1e-5)


def test_others_take_what_they_have_in_common_with_ours() -> None:
    usual, of_van = space("LinearObserver", {}), space("LinearObserver", VAN)
    assert of_van.computed["L_phi"] == space(OURS, VAN).computed["L_phi"] != usual.computed["L_phi"]
    washout = space("SpeedWashout", VAN)
    assert [each.name for each in washout.searched] == ["k_v", "omega_v", "zeta_v"]
    assert washout.computed.keys() == set(AUTHORITY)


def test_the_paper_s_observer_gets_the_gains_of_its_own_model() -> None:
    usual, of_van = space("PaperObserver", {}), space("PaperObserver", VAN)
    estimator = {name for name in declared("PaperObserver") if name.startswith("L")}
    assert usual.computed == {name: declared("PaperObserver")[name].start for name in (*estimator, "T_age", *AUTHORITY)}
    assert of_van.computed.keys() == usual.computed.keys()
    assert of_van.computed["L_phi"] == pytest.approx(literal_observer(*records(VAN))["L_phi"], rel=1e-5)
    assert of_van.computed["L_phi"] != pytest.approx(usual.computed["L_phi"], rel=0.01)


def test_what_has_nothing_to_search_is_refused() -> None:
    with pytest.raises(DrivelineError, match="NoDamping has no parameter that is searched"):
        space("NoDamping", {})


@pytest.mark.parametrize("each", [Searched("k", 2.0, 0.2, 10.0), Searched("T", 0.004, 0.0, 0.012)])
def test_a_coordinate_is_zero_at_the_start_and_ends_with_the_range(each: Searched) -> None:
    assert each.coordinate(each.start) == 0.0
    assert each.value(0.0) == each.start
    for value in (each.low, 0.9 * each.start, each.high):
        assert each.value(each.coordinate(value)) == pytest.approx(value, rel=1e-5)
    assert each.value(99.0) == each.high
    assert each.value(-99.0) == each.low


def test_a_range_above_zero_goes_by_factors_and_others_by_halves() -> None:
    assert Searched("k", 2.0, 0.2, 10.0).value(1.0) == pytest.approx(2.0 * 2.718282, rel=1e-5)
    assert Searched("T", 0.004, 0.0, 0.012).value(1.0) == pytest.approx(0.01)


def test_a_candidate_has_the_digits_of_a_file() -> None:
    assert Searched("k", 2.0, 0.2, 10.0).value(0.1) == 2.21034

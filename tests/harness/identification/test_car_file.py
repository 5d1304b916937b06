"""What identification leaves behind: a vehicle file that every command takes, and a document with all of it."""

import json
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from driveline.fmus.building.parameter_files import read_vehicle
from driveline.harness.identification import car_file, prior_knowledge
from driveline.harness.identification.car_file import WIDEST_INTERVAL
from driveline.harness.identification.diagnostics import LACKING
from driveline.harness.identification.drive_train import Parameters
from driveline.harness.identification.drive_train_response import resonance, rolling_tyre
from driveline.harness.identification.driven_plants import diagnose_driven
from driveline.harness.identification.estimator import PRIORS, UNTOLD, Z_95
from driveline.harness.identification.identification_report_html import verdict
from driveline.harness.identification.identify import WITHOUT_LOAD, Identified, Quality
from driveline.harness.identification.step import Step
from driveline.harness.identification.two_mass_equivalent import detailed_over_design, equivalent
from driveline.harness.loop.settings import Settings
from driverecords.measurement import Measurement
from driverecords.source import RecordingError
from tests.harness.identification.simulated import LOOP, NOISE, identified
from toolground.errors import UserError

FOUND = identified()
LACKS = identified(lack_L=1.01 * LACKING * NOISE.T_load)
"""The load torque has what the model does not explain."""

GIVEN = {"m": 2100.0, "J_2": 0.31, "C": 90.0, "tau": 0.004}


def known_to(name: str, half: float, of: Identified = FOUND) -> Identified:
    """A parameter with so much as half of its 95 % interval."""
    one = replace(of.found)
    covariance, k = of.found.covariance.copy(), of.found.free.index(name)
    covariance[k, :] = covariance[:, k] = 0.0
    covariance[k, k] = (half / Z_95) ** 2
    vars(one)["covariance"] = covariance
    return replace(of, found=one)


@pytest.mark.parametrize("of", [FOUND, LACKS], ids=["explained", "not explained"])
def test_the_vehicle_file_is_read_back(of: Identified, tmp_path: Path) -> None:
    path = tmp_path / "car.toml"
    path.write_text(car_file.vehicle_file(of, "The car of a drive.", GIVEN), encoding="utf-8")
    assert read_vehicle(path) == car_file.identified_car(of, GIVEN)


def test_a_car_that_the_model_explains_is_written_as_it_was_found() -> None:
    p = FOUND.p
    expected = {"m": 2100.0, "J_2": p.J_2, "C": p.C, "phi_B": p.phi_B, "tau": 0.00312346}
    assert car_file.identified_car(FOUND, GIVEN) == pytest.approx(expected, rel=1e-5)
    assert car_file.identified_car(replace(FOUND, loop=None)).keys() == {"C", "J_2", "phi_B"}


def swings(p: Parameters, of: Identified) -> float:
    """Frequency in Hz at which the design model answers most with this car, on the tyre of the vehicle file."""
    file = of.found.centre
    return resonance(p._replace(d=0.0), rolling_tyre(file, of.predictor.behind, of.speed))


def test_of_a_car_that_it_does_not_explain_a_detailed_car_swings_as_it_was_found() -> None:
    entries = car_file.identified_car(LACKS, GIVEN)
    assert entries["J_2"] == GIVEN["J_2"], "as it was"
    car = equivalent(LACKS, LACKS.p)
    assert entries["C"] == pytest.approx(car.C, rel=1e-5)
    assert detailed_over_design() * swings(car, LACKS) == pytest.approx(LACKS.resonance, rel=1e-4)


def test_without_the_load_torque_the_design_swings_as_it_was_found() -> None:
    alone = replace(FOUND, name=WITHOUT_LOAD)
    car = equivalent(alone, FOUND.p)
    assert car.J_2 == FOUND.found.centre.J_2
    assert swings(car, FOUND) == pytest.approx(FOUND.resonance, rel=1e-4)
    assert "J_2" not in car_file.identified_car(alone)
    assert "effective, without load torque: J_2 carries the vehicle" in car_file.identified_lines(alone)[0]


def gap(of: Identified) -> tuple[float, float]:
    (row,) = (row for row in car_file.rows_of(of) if row.name == "phi_B")
    return row.value, row.half


def test_of_a_car_that_is_not_explained_the_plant_that_was_driven_tells_stiffness_and_gap() -> None:
    by = Step("ValidationVehicle", {"C": 120.0, "phi_B": 0.17}, {"C": 0.02, "phi_B": 0.01}, 0.2, 0.15)
    car = replace(LACKS, plant_fit=by)
    assert car_file.of_car(car) == pytest.approx((120.0, 2.4))
    assert gap(car) == pytest.approx((0.17, 0.0017))
    assert car_file.identified_car(car) == {"C": 120.0, "phi_B": 0.17, "tau": 0.00312346}
    assert "ValidationVehicle, driven by the recorded torque, meets" in next(diagnose_driven(car))
    wide = replace(by, halves={"C": 0.02, "phi_B": 1.01 * WIDEST_INTERVAL})
    assert "phi_B" not in car_file.identified_car(replace(LACKS, plant_fit=wide))


NO_PLANT = ", so wide is its interval, as no plant that was driven by the recorded torque confirms it"


@pytest.mark.parametrize(
    ("of", "share", "message"),
    [
        (LACKS, 0.1, f"the gap of two masses is not that of this car: phi_B may be off by up to 10 %{NO_PLANT}"),
        (replace(FOUND, name=WITHOUT_LOAD), 0.3, f"without load torque: phi_B may be off by up to 30 %{NO_PLANT}"),
    ],
)
def test_a_gap_that_no_plant_confirms_is_as_wide_as_the_filter_may_be_off(
    of: Identified, share: float, message: str
) -> None:
    value, half = gap(of)
    assert half == pytest.approx(share * value)
    *others, said = diagnose_driven(of)
    assert said == message
    assert [text.partition(" predict ")[0] for text in others] == ["J_2, C and d of the filter"] * (of is not LACKS)
    assert gap(FOUND)[1] < 0.1 * value


def test_what_was_identified_is_not_lost_where_no_plants_can_be_built(monkeypatch: pytest.MonkeyPatch) -> None:
    def built(loops: Iterable[Settings]) -> None:
        assert {made.build for made in loops} == {"native"}, "the other takes minutes"
        raise UserError("no C compiler")

    monkeypatch.setattr(prior_knowledge, "built_together", built)
    monkeypatch.setattr(prior_knowledge, "identified_from", lambda *_: LACKS)
    one = prior_knowledge.identify(object.__new__(Measurement))
    assert (one.found, one.plant_fit, one.warnings[:-1]) == (LACKS.found, None, LACKS.warnings)
    assert one.warnings[-1].endswith("as the plants that would confirm it could not be driven: no C compiler")


def test_entries_of_every_type_stay() -> None:
    """true and false, as TOML has them."""
    text = car_file.vehicle_file(FOUND, "A car.", {"m": 2100, "whatever": True, "other": False})
    assert "\nm = 2100\nwhatever = true\nother = false\n" in text


def test_shafts_that_were_known_give_way_to_the_stiffness_that_was_identified() -> None:
    entries = car_file.identified_car(FOUND, {**GIVEN, "k_s": 3e4, "k_g": 2e5, "k_p": 9e4, "J_w": 2.0})
    assert entries.keys() == {*GIVEN, "phi_B", "J_w"}


def test_a_stiffness_that_is_hardly_known_makes_no_vehicle_file() -> None:
    half = WIDEST_INTERVAL * FOUND.p.C
    assert car_file.identified_car(known_to("C", 0.99 * half))["C"] == pytest.approx(FOUND.p.C, rel=1e-5)
    with pytest.raises(RecordingError, match=r"C of the car = 117 .* is known to \+- 5. % only.*excite more"):
        car_file.vehicle_file(known_to("C", 1.01 * half), "A car.")


@pytest.mark.parametrize(
    ("name", "share", "there"), [("phi_B", 0.99, True), ("phi_B", 1.01, False), ("J_2", 1.01, False)]
)
def test_what_is_hardly_known_stays_as_it_was(name: str, share: float, there: bool) -> None:
    entries = car_file.identified_car(known_to(name, share * WIDEST_INTERVAL * getattr(FOUND.p, name)), {name: 0.1})
    assert (entries[name] != 0.1) == there


def test_what_the_recording_does_not_tell_is_said_to_be_what_is_known_of_cars() -> None:
    least = UNTOLD * PRIORS["phi_B"].deviation * FOUND.p.phi_B * Z_95
    for share, told in ((0.99, True), (1.01, False)):
        one = known_to("phi_B", share * least)
        (line,) = (line for line in car_file.identified_lines(one) if line.startswith("  phi_B "))
        assert ("told by motor speed" in line or "told by load torque" in line) == told
        assert ("not told: what is known of cars" in line) == (not told)
        assert ("phi_B not told" in verdict(one)) == (not told)


def test_people_are_told_each_parameter_with_its_interval_and_unit_and_what_told_it() -> None:
    lines = car_file.identified_lines(FOUND)
    assert lines[0].startswith("identified with load torque: J_2 is that of the wheels alone, C that between")
    rows = {line.split()[0]: line for line in lines[1:13]}
    assert [*rows] == ["J_2", "C", "d", "phi_B", "g_T", "g_L", "late_T", "late_L", "c_t", "sigma_t", "tau", "late_2"]
    assert rows["C"].startswith(f"  C       = {FOUND.p.C:.5g} +- {Z_95 * FOUND.found.deviations['C']:.2g} N.m/rad ")
    assert " ".join(rows["tau"].split()) == "tau = 0.0031235 +- 2e-05 s (0.63 %) told by torque demand"
    assert " ".join(rows["late_2"].split()) == "late_2 = 0.035 +- 0.002 s told by wheel speed"
    assert "%" not in rows["late_T"] + rows["d"], "0 is as good a value as another"
    assert lines[13].startswith(f"in the vehicle file C = {FOUND.p.C:.5g} +- ")
    assert lines[14] == f"the car answers most at {FOUND.resonance:.2f} Hz"
    assert lines[15].endswith("motor speed 97.0 %, load torque 92.0 %")


def test_the_interval_of_the_stiffness_in_the_file_is_that_of_what_it_is_made_of() -> None:
    """As found where the model explains; else by the frequency, whose change with each parameter counts."""
    assert car_file.of_car(FOUND) == pytest.approx((FOUND.p.C, Z_95 * FOUND.found.deviations["C"]), rel=1e-3)
    sure = known_to("C", 3.0, LACKS)
    C = [equivalent(LACKS, LACKS.p._replace(C=LACKS.p.C + by)).C for by in (-3.0, 3.0)]
    assert car_file.of_car(sure)[1] > 0.95 * 0.5 * (C[1] - C[0])
    assert car_file.of_car(sure)[1] < 1.3 * 0.5 * (C[1] - C[0])


def test_the_file_tells_in_comments_what_was_found_and_what_is_odd() -> None:
    head, _, body = car_file.vehicle_file(FOUND, "The car of a drive.").partition("\n\n")
    assert head.startswith("# The car of a drive.\n#\n# identified with load torque")
    assert "\n# warning: something is odd\n" in head
    assert all(line.startswith("#") and len(line) <= 120 for line in head.splitlines())
    assert [line.split(" = ")[0] for line in body.splitlines()] == ["C", "J_2", "phi_B", "tau"]


@pytest.mark.parametrize(
    "one",
    [FOUND, replace(FOUND, loop=None, name=WITHOUT_LOAD, quality=Quality(97.0, float("nan"), 1.0, 0.0))],
    ids=["with", "without"],
)
def test_the_document_is_json_with_all_of_it(one: Identified) -> None:
    read = json.loads(json.dumps(car_file.document(one), allow_nan=False))
    assert read["identified"] == one.name
    assert read["parameters"] == pytest.approx(one.p._asdict())
    assert read["standard_deviations"] == pytest.approx(one.found.deviations)
    np.testing.assert_allclose(read["covariance"], one.found.covariance)
    assert read["intervals_95"]["C"]["told_by"] == one.found.told_by("C")
    assert read["resonance_Hz"] == pytest.approx(one.resonance)
    assert read["fit"]["omega_1"] == 97.0
    assert ("T_load" in read["fit"]) == (one is FOUND)
    assert read["warnings"] == ["something is odd"]
    assert (read["torque_loop"] is None) == (one.loop is None)
    if one.loop:
        assert read["torque_loop"]["tau"] == LOOP.loop.tau
        assert read["torque_loop"]["standard_deviations"]["delay"] == 1e-5

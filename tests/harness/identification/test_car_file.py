"""What identification leaves behind: a vehicle file that every command takes, and a document with all of it."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from driveline.fmus.building.parameter_files import read_vehicle
from driveline.harness.identification import car_file
from driveline.harness.identification.car_file import WIDEST_INTERVAL
from driveline.harness.identification.drive_train_response import Tyre, resonance
from driveline.harness.identification.identification_report_html import verdict
from driveline.harness.identification.identify import WITH_LOAD, WITHOUT_LOAD, Identified
from driveline.harness.identification.quality import Z_95, Quality
from driveline.harness.identification.torque_loop import PARAMETERS, FittedLoop, TorqueLoop
from driveline.harness.identification.two_mass_equivalent import equivalent
from driveline.harness.recordings.source import RecordingError
from tests.harness.identification.simulated import NOISE, P, simulated

FREE = ("J_2", "C", "phi_B", "g_L")
LOOP = FittedLoop(TorqueLoop(0.0031234567, 1.01, 0.2, 0.0), dict.fromkeys(PARAMETERS, 1e-5), 0.3, 0.99)
FOUND = Identified(
    name=WITH_LOAD,
    method="prediction error",
    p=P,
    covariance=np.diag(np.square([1e-3, 0.1, 2e-4, 3e-3])),
    free=FREE,
    noise=NOISE,
    loop=LOOP,
    tyre=Tyre(480.0, 30.0, 1.5, 0.97),
    quality=Quality(97.0, 99.0, 96.0, 1.02, 0.03),
    drive=simulated(seed=1, n=20),
    warnings=("something is odd",),
)
GIVEN = {"m": 2100.0, "J_2": 0.31, "C": 90.0, "tau": 0.004}


def test_the_vehicle_file_is_read_back(tmp_path: Path) -> None:
    path = tmp_path / "car.toml"
    path.write_text(car_file.vehicle_file(FOUND, "The car of a drive.", GIVEN), encoding="utf-8")
    assert read_vehicle(path) == car_file.identified_car(FOUND, GIVEN)


def test_what_was_identified_replaces_entries_and_the_others_stay() -> None:
    entries = car_file.identified_car(FOUND, GIVEN)
    same = equivalent(P, FOUND.tyre, FOUND.resonance)
    assert entries == pytest.approx({"m": 2100.0, "J_2": 0.31, "C": same.C, "phi_B": P.phi_B, "tau": 0.00312346}, 1e-5)
    assert same.C != pytest.approx(P.C, rel=1e-2)


def test_entries_of_every_type_stay(tmp_path: Path) -> None:
    """true and false, as TOML has them."""
    text = car_file.vehicle_file(FOUND, "A car.", {"m": 2100, "whatever": True, "other": False})
    assert "\nm = 2100\nwhatever = true\nother = false\n" in text


def test_what_was_not_free_is_not_written() -> None:
    assert car_file.identified_car(replace(FOUND, loop=None), {}).keys() == {"C", "phi_B"}
    freed = replace(FOUND, free=("J_1", *FREE[1:]))
    assert car_file.identified_car(freed, {})["J_1"] == P.J_1


def known_to(name: str, share: float) -> Identified:
    """A parameter with half a 95 % interval of so much of its value."""
    k = FREE.index(name)
    covariance = FOUND.covariance.copy()
    covariance[k, k] = (share * getattr(P, name) / Z_95) ** 2
    return replace(FOUND, tyre=None, covariance=covariance)


def test_a_stiffness_that_is_hardly_known_makes_no_vehicle_file() -> None:
    assert car_file.identified_car(known_to("C", 0.999 * WIDEST_INTERVAL), {})["C"] == pytest.approx(P.C, rel=1e-6)
    with pytest.raises(
        RecordingError, match=r"C of the car = 117 \+- 59 N.m/rad is known to \+- 50 % only.*excite more"
    ):
        car_file.vehicle_file(known_to("C", 1.001 * WIDEST_INTERVAL), "A car.")


def test_what_is_not_determined_is_told_so_and_not_as_a_number() -> None:
    for share, told in ((0.999, "phi_B = 0.157 +- 0.16 rad (1e+02 %)"), (1.001, "phi_B is not determined")):
        found = known_to("phi_B", share)
        assert f"  {told}" in car_file.identified_lines(found)
        assert told.partition(" (")[0].replace("+-", "±") in verdict(found)
        assert car_file.document(found)["intervals_95"]["phi_B"]["determined"] == (share < 1.0)


def freed(**values: float) -> Identified:
    """The fourth parameter is another one, with a standard deviation of 3e-3 and so half an interval of 5.9e-3."""
    return replace(FOUND, tyre=None, p=P._replace(**values), free=("J_2", "C", "phi_B", *values))


def test_damping_whose_interval_holds_zero_is_not_determined() -> None:
    for d, told in ((0.02, "d     = 0.02 +- 0.0059 N.m.s/rad (29 %)"), (0.005, "d     is not determined")):
        assert f"  {told}" in car_file.identified_lines(freed(d=d))


def test_of_a_delay_zero_is_as_good_a_value_as_another() -> None:
    """It has no per cent, and is determined if it is known to .2 ms."""
    assert "  late_1 is not determined" in car_file.identified_lines(freed(late_1=1e-3))
    short = replace(freed(late_1=1e-5), covariance=np.diag(np.square([1e-3, 0.1, 2e-4, 0.95e-4])))
    assert "  late_1 = 1e-05 +- 0.00019 s" in car_file.identified_lines(short)


@pytest.mark.parametrize("name", ["J_2", "C"])
def test_without_a_drive_train_nothing_of_it_is_determined(name: str) -> None:
    """But the lag of motor control, which the torques tell."""
    lines = car_file.identified_lines(known_to(name, 1.001))
    assert lines[1:7] == [
        "  J_2   is not determined",
        "  C     is not determined",
        "  phi_B is not determined",
        "  g_L   is not determined",
        "  tau   = 0.0031235 +- 2e-05 s (0.63 %)",
        "the frequency at which the car answers most is not determined",
    ]
    with pytest.raises(RecordingError, match=r"^C of the car is not determined, and a vehicle file needs \+- 50 %"):
        car_file.identified_car(known_to(name, 1.001))


def test_an_answer_that_grows_to_the_edge_has_no_peak() -> None:
    """Of a motor with next to no inertia behind it: the slower, the larger."""
    light = replace(FOUND, p=P._replace(J_2=1e-5, d=5.0), tyre=None, covariance=1e-12 * np.eye(4))
    assert "the frequency at which the car answers most is not determined" in car_file.identified_lines(light)


def test_a_gap_that_is_hardly_known_stays_as_it_was() -> None:
    given = {"phi_B": 0.1}
    assert car_file.identified_car(known_to("phi_B", 0.999 * WIDEST_INTERVAL), given)["phi_B"] == P.phi_B
    assert car_file.identified_car(known_to("phi_B", 1.001 * WIDEST_INTERVAL), given)["phi_B"] == 0.1


def test_without_the_load_torque_the_stiffness_is_that_of_the_two_masses() -> None:
    found = replace(FOUND, name=WITHOUT_LOAD, tyre=None)
    assert car_file.identified_car(found, {})["C"] == pytest.approx(P.C, rel=1e-6)
    assert "effective, without load torque" in car_file.identified_lines(found)[0]
    assert "J_2 carries the vehicle" in car_file.identified_lines(found)[0]


def test_people_are_told_each_parameter_with_its_interval_and_unit() -> None:
    lines = car_file.identified_lines(FOUND)
    assert lines[0] == (
        "identified with load torque, by prediction error: "
        "J_2 is that of the wheels alone, C that between motor and wheels; 95 % intervals"
    )
    assert lines[1:6] == [
        "  J_2   = 0.3 +- 0.002 kg.m2 (0.65 %)",
        "  C     = 117.4 +- 0.2 N.m/rad (0.17 %)",
        "  phi_B = 0.157 +- 0.00039 rad (0.25 %)",
        "  g_L   = 0.99 +- 0.0059 (0.59 %)",
        "  tau   = 0.0031235 +- 2e-05 s (0.63 %)",
    ]
    C, half = car_file.of_car(FOUND)
    assert lines[6].startswith(f"in the vehicle file C = {C:.5g} +- {half:.2g} N.m/rad (")
    assert lines[7] == f"the car answers most at {FOUND.resonance:.2f} Hz"


def test_the_stiffness_in_the_file_is_the_one_that_is_told() -> None:
    C, _ = car_file.of_car(FOUND)
    assert car_file.identified_car(FOUND)["C"] == pytest.approx(C, rel=1e-5)
    assert f"in the vehicle file C = {C:.5g}" in car_file.vehicle_file(FOUND, "A car.")
    assert car_file.document(FOUND)["vehicle_file"]["C"] == car_file.identified_car(FOUND)["C"]
    assert car_file.document(FOUND)["intervals_95"]["C"] == {
        "value": P.C,
        "half": pytest.approx(0.196, abs=1e-3),
        "determined": True,
    }


@pytest.mark.slow
def test_its_interval_is_that_of_what_it_is_made_of() -> None:
    """Here by draws."""
    _, half = car_file.of_car(FOUND)
    draws = np.random.default_rng(1).multivariate_normal([getattr(P, name) for name in FREE], FOUND.covariance, 300)
    drawn = [P._replace(**dict(zip(FREE, map(float, values), strict=True))) for values in draws]
    found = [equivalent(p, FOUND.tyre, resonance(p, FOUND.tyre)).C for p in drawn]
    assert half == pytest.approx(1.96 * np.std(found), rel=0.15)


def test_where_there_is_one_stiffness_no_other_is_told() -> None:
    lines = car_file.identified_lines(replace(FOUND, name=WITHOUT_LOAD, tyre=None))
    assert not any(line.startswith("in the vehicle file") for line in lines)


def test_a_stiffness_without_tyres_is_told_to_be_the_one_in_the_file() -> None:
    lines = car_file.identified_lines(replace(FOUND, tyre=None))
    assert any(line.startswith("in the vehicle file C = 117.4 +- 0.2 N.m/rad") and "no tyre" in line for line in lines)


def test_shafts_that_were_known_give_way_to_the_stiffness_that_was_identified() -> None:
    entries = car_file.identified_car(FOUND, {**GIVEN, "k_s": 3e4, "k_g": 2e5, "k_p": 9e4, "J_w": 2.0})
    assert entries.keys() == {*GIVEN, "phi_B", "J_w"}


def test_the_file_tells_in_comments_what_was_found_and_what_is_odd() -> None:
    head, _, body = car_file.vehicle_file(FOUND, "The car of a drive.").partition("\n\n")
    assert head.startswith("# The car of a drive.\n#\n# identified with load torque")
    assert "\n# warning: something is odd\n" in head
    assert all(line.startswith("#") and len(line) <= 120 for line in head.splitlines())
    assert [line.split(" = ")[0] for line in body.splitlines()] == ["C", "phi_B", "tau"]


@pytest.mark.parametrize("found", [FOUND, replace(FOUND, loop=None, tyre=None, name=WITHOUT_LOAD)])
def test_the_document_is_json_with_all_of_it(found: Identified) -> None:
    read = json.loads(json.dumps(car_file.document(found), allow_nan=False))
    assert read["identified"] == found.name
    assert read["parameters"] == pytest.approx(P._asdict())
    assert read["free"] == list(FREE)
    assert read["standard_deviations"] == pytest.approx(dict(zip(FREE, (1e-3, 0.1, 2e-4, 3e-3), strict=True)))
    np.testing.assert_allclose(read["covariance"], found.covariance)
    assert read["resonance_Hz"] == pytest.approx(found.resonance)
    assert read["fit"]["predicted"] == 96.0
    assert read["warnings"] == ["something is odd"]
    assert (read["tyre"] is None) == (read["torque_loop"] is None) == (found.loop is None)
    if found.loop:
        assert read["torque_loop"]["tau"] == LOOP.loop.tau
        assert read["torque_loop"]["standard_deviations"]["delay"] == 1e-5
        assert found.tyre
        assert read["tyre"] == vars(found.tyre)

"""One car for both plants and the design: what follows from what a vehicle file names."""

from collections.abc import Callable
from math import exp, pi, sqrt
from pathlib import Path

import numpy as np
import pytest
from fmutesting.together import together

from docs.studies.data_file import ROOT
from docs.studies.one_car import cars, frequencies
from driveline.fmus.building.estimates import LAWS
from driveline.fmus.building.one_car import (
    DEFAULT_CAR,
    DESIGN,
    DETAILED,
    FOLLOW,
    INSTEAD,
    SHAFTS,
    _solved,
    of_one_car,
    updated,
)
from driveline.fmus.building.oscillation import SPEED, oscillation
from driveline.fmus.building.parameter_files import read_vehicle
from driveline.fmus.errors import ParameterFileError
from driveline.harness.studies.margins.linear_plant import linear_plant
from driveline.harness.studies.margins.operating_point import Point
from fmublocks.block.types import ContinuousBlock

EXAMPLES = sorted((ROOT / "examples" / "cars").glob("*.toml"))

APART = frequencies({}).apart
"""Frequency of the validation vehicle over that of the design model, in the default car."""


def followed(**entries: float) -> dict[str, float]:
    """What follows for all that there is."""
    return {name: value for name, value in of_one_car(entries, FOLLOW).items() if name not in entries}


def refusal(**entries: float) -> str:
    with pytest.raises(ParameterFileError) as found:
        of_one_car(entries, FOLLOW)
    assert "\n" not in str(found.value)
    return str(found.value)


@together("name, car", cars().items())
def test_both_plants_swing_as_far_apart_as_with_the_default_car(name: str, car: dict[str, float]) -> None:
    """The examples and 20 drawn ones; the goal is 3 %."""
    assert frequencies(car).apart == pytest.approx(APART, rel=1e-4), name


def test_the_default_car_is_left_as_it_is() -> None:
    every = {name: start for name, start in DEFAULT_CAR.items() if name in FOLLOW or name in DESIGN.Parameters._fields}
    assert followed() == {}
    assert followed(**every) == {}
    for name in every.keys() - {*SHAFTS}:
        assert followed(**{name: every[name]}) == {}, name
    assert followed(phi_B=0.3) == {}


@together("name", ["C", "k_s"])
def test_numbers_of_all_kinds_are_taken_and_nothing_else(name: str) -> None:
    value = 1.1 * DEFAULT_CAR[name] // 1
    for kind in (np.float64, np.float32, int):
        assert of_one_car({name: kind(value)}, FOLLOW) == of_one_car({name: value}, FOLLOW)
    for value in ("stiff", None, [1.0]):
        with pytest.raises(ParameterFileError, match=rf"^{name} = .*: it must be a number$"):
            of_one_car({name: value}, FOLLOW)


def test_gains_and_other_blocks_pass() -> None:
    assert of_one_car({"k_d": 3.0, "tau": 0.002, "T_cyc": 0.05}, FOLLOW) == {"k_d": 3.0, "tau": 0.002, "T_cyc": 0.05}


def test_a_stiffer_drive_train_is_stiffer_in_detail_with_the_same_shares() -> None:
    found = followed(C=160.0)
    ratios = {name: found[name] / DEFAULT_CAR[name] for name in SHAFTS}
    assert min(ratios.values()) > 160.0 / 117.4, "as the tyres stay as soft as they were"
    assert ratios["k_g"] == pytest.approx(ratios["k_s"], rel=1e-5)
    assert ratios["k_p"] == pytest.approx(ratios["k_s"], rel=1e-5)
    assert "C" not in found


@together("C", [60.0, 160.0])
def test_shafts_alone_give_the_design_its_stiffness(C: float) -> None:
    """The way back."""
    shafts = {name: followed(C=C)[name] for name in SHAFTS}
    assert followed(**shafts)["C"] == pytest.approx(C, rel=1e-4)
    assert followed(k_s=shafts["k_s"])["C"] == pytest.approx(C, rel=1e-4), "gear and mounts keep their shares"


def test_what_the_design_alone_takes_follows_without_the_details() -> None:
    assert of_one_car({"k_s": 40000.0}, DESIGN.Parameters._fields).keys() == {"k_s", "C"}
    assert of_one_car({"C": 500.0}, DESIGN.Parameters._fields) == {"C": 500.0}, "which no shafts can make"


def test_one_of_gear_and_mounts_stands_and_the_others_make_up_for_it() -> None:
    found = followed(C=117.4, k_g=4e5)
    assert found.keys() >= {"k_s", "k_p"}
    assert found["k_s"] < DEFAULT_CAR["k_s"]
    assert frequencies({"C": 117.4, "k_g": 4e5}).apart == pytest.approx(APART, rel=1e-4)
    assert followed(k_g=4e5)["C"] > DEFAULT_CAR["C"]


def test_wheels_follow_from_their_inertia_and_pitch_and_dampers_keep_their_damping_ratio() -> None:
    found = followed(J_2=0.6, i=4.5)
    assert (found["J_w"], found["J_g"]) == pytest.approx((1.8 * 0.5, 0.1 * 0.5))
    assert "J_w" not in followed(J_2=0.6, J_w=2.0)
    found = followed(m=2900.0)
    assert {found[name] / DEFAULT_CAR[name] for name in ("F_z0", "J_y", "k_th", "d_th")} == {2.0}
    found = followed(J_2=1.2, C=80.0)
    k, J = found["k_s"] / DEFAULT_CAR["k_s"], found["J_w"] / DEFAULT_CAR["J_w"]
    assert found["d_s"] / DEFAULT_CAR["d_s"] == pytest.approx((k * J) ** 0.5, rel=1e-5)


@together("k_s, disagrees", [(0.90, True), (0.92, False), (1.08, False), (1.12, True)])
def test_shafts_that_make_another_frequency_by_three_per_cent_disagree(k_s: float, disagrees: bool) -> None:
    entries = {"C": 117.4, **{name: k_s * DEFAULT_CAR[name] for name in SHAFTS}}
    apart = frequencies({name: entries[name] for name in SHAFTS}).design / frequencies({}).design
    if not disagrees:
        assert 1.0 / 1.03 < apart < 1.03
        assert of_one_car(entries, FOLLOW).items() >= entries.items()
        return
    assert not 1.0 / 1.03 < apart < 1.03
    message = refusal(**entries)
    assert message.startswith(f"C = 117.4 N.m/rad and k_s = {entries['k_s']:g} N.m/rad, k_g = ")
    assert "with that C would be 1" in message


@together(
    "entries, message",
    [
        (
            {"C": 300.0},
            "C = 300 N.m/rad: the frequency of the drive train would have to be 12.9 Hz, and that of Validation",
        ),
        ({"J_w": 24.95}, "J_w + J_g = 25.05 kg.m2 and J_2 = 0.3 kg.m2 disagree: with i = 9 J_2 is 24.3 kg.m2 at the"),
        ({"F_z0": 14700.0}, "F_z0 = 14700 N and m = 1450 kg disagree: 1.47e+04 N are more than"),
        ({"m_h": 900.0}, "m_h = 900 kg and F_z0 = 8500 N disagree: 8829 N are more than"),
        (
            {"J_2": 0.004},
            "J_2 = 0.004 kg.m2: J_w = 0.024 kg.m2 would follow, and ValidationVehicle takes 0.05 to 200 kg.m2",
        ),
        ({"m": 1.0}, "m = 1: ValidationVehicle takes 300 to 40000 kg"),
        ({"frequency": 7.0, "C": 90.0}, "frequency = 7 Hz, C = 90 N.m/rad: leave one out, as C follows from frequency"),
        ({"gap": 0.04, "phi_B": 0.1}, "gap = 0.04 rad, phi_B = 0.1 rad: leave one out, as phi_B follows from gap"),
        ({"damping_ratio": 0.1, "d_s": 9.0}, "damping_ratio = 0.1, d_s = 9 N.m.s/rad: leave one out"),
        ({"frequency": 0.29}, "frequency = 0.29: a vehicle file takes 0.3 to 30 Hz"),
        (
            {"frequency": 25.0},
            "frequency = 25 Hz: the frequency of the drive train would have to be 25 Hz, and that of Validation",
        ),
        (
            {"damping_ratio": 0.006},
            "damping_ratio = 0.006: the damping ratio of the drive train would have to be 0.006, and that of Vali",
        ),
        (
            {"frequency": 30.0, "m": 40000.0, "i": 20.0, "T_max": 1300.0},  # C leaps over it to another mode
            "frequency = 30 Hz, m = 40000 kg, i = 20, T_max = 1300 N.m: the frequency of the drive train would have",
        ),
        ({"gap": 0.21, "i": 9.0}, "gap = 0.21: a vehicle file takes 0 to 0.2 rad"),
    ],
)
def test_a_car_that_cannot_be_is_refused_with_both_numbers(entries: dict[str, float], message: str) -> None:
    assert refusal(**entries).startswith(message)


@together("entries", [{"J_w": 24.9}, {"F_z0": 14600.0}, {"m_h": 890.0}, {"J_2": 0.0235, "J_w": 1.8}])
def test_measured_numbers_need_not_agree_to_the_last_digit(entries: dict[str, float]) -> None:
    assert of_one_car(entries, ()).items() >= entries.items()


def test_a_car_by_its_data_sheet_is_estimated_through_the_default_car() -> None:
    """The motor is eight times as strong, the wheels are twice as large, the gear has twice the ratio."""
    found = followed(T_max=1440.0, r=0.58, i=18.0, m=2900.0)
    expected = {"J_1": 16.0, "J_2": 8.0, "C": 4.0, "phi_B": 2.0, "c_slip": 2.0}
    assert {name: found[name] / DEFAULT_CAR[name] for name in expected} == pytest.approx(expected, rel=1e-5)
    assert followed(T_max=180.0, r=0.29, i=9.0, m=1450.0) == {}
    assert followed(F_z0=4250.0)["c_slip"] == followed(F_z0=4250.0, m=2900.0)["c_slip"] == 70000.0, "the load decides"
    truck = followed(m=40000.0)
    assert (truck["F_z0"], truck["c_slip"]) == pytest.approx((11500 * 9.81, 11500 * 9.81 / 8500 * 140000), rel=1e-5)
    assert "F_z0" not in of_one_car({"m": 19200.0}, ())
    assert of_one_car({"T_max": 1.0}, ())["J_1"] == 0.001, "no less than a block takes"
    assert refusal(T_max=1.0).endswith("; estimated: J_1, C")
    measured = refusal(T_max=310.0, frequency=7.2, damping_ratio=0.03, gap=0.04)
    assert measured.endswith("; estimated: J_1"), "what was measured is not asked for"
    assert "C" not in followed(T_max=360.0, k_s=25800.0, k_g=120000.0, k_p=70000.0, J_1=0.055), "which has its shafts"


@together("path", EXAMPLES)
def test_what_is_estimated_is_off_by_a_factor_of_two_on_the_examples(path: Path) -> None:
    entries = read_vehicle(path)
    full = of_one_car(entries, ())
    known = {name: full[name] for name in LAWS if name in full}
    others = {name: value for name, value in entries.items() if name not in {*LAWS, *INSTEAD}}
    for name, value in of_one_car(others, ()).items():
        if name in known:
            assert max(value / known[name], known[name] / value) < (3.1 if name == "phi_B" else 2.05), name


def test_what_is_measured_of_a_whole_car_is_that_of_the_validation_vehicle() -> None:
    entries = {"m": 1900.0, "J_1": 0.07, "frequency": 6.5, "damping_ratio": 0.12, "gap": 0.04, "i": 10.0}
    found = of_one_car(entries, FOLLOW)
    assert found.keys().isdisjoint({"frequency", "damping_ratio", "gap"})
    assert found["phi_B"] == 0.2
    p = DETAILED.Parameters(**{name: found[name] for name in DETAILED.Parameters._fields if name in found})
    assert oscillation(DETAILED, p) == pytest.approx((6.5, 0.12), rel=3e-3)
    assert frequencies(entries).apart == pytest.approx(APART, rel=1e-3)
    assert updated(entries, {"C": 90.0, "phi_B": 0.1}).keys() == {"m", "J_1", "damping_ratio", "i", "C", "phi_B"}


def test_a_stiffness_that_becomes_known_replaces_the_shafts() -> None:
    car = {"m": 1900.0, "k_s": 3e4}
    assert updated(car, {"C": 120.0}) == {"m": 1900.0, "C": 120.0}
    assert updated(car, {"phi_B": 0.1}) == {**car, "phi_B": 0.1}


@together(
    "frequency, most",
    [
        (lambda k: sqrt(k / (1.0 + k / 50.0)), 7),  # as a spring in series with another
        (lambda k: 1.0 + (k > 3.0) + 1e-3 * k, 60),  # steps lead nowhere: halved
        (lambda k: exp(min(k, 9.0)), 60),
    ],
)
def test_a_stiffness_is_found_in_few_linearisations_where_frequencies_are_those_of_springs(
    frequency: Callable[[float], float], most: int
) -> None:
    asked = list[float]()

    def seen(k: float) -> float:
        asked.append(k)
        return frequency(k)

    for k in (0.02, 0.9, 8.0):
        asked.clear()
        assert _solved(DESIGN, seen, frequency(k), 0.01, 100.0) == pytest.approx(k, rel=1e-8)
        assert len(asked) <= most


def test_on_a_stiff_tyre_the_motor_swings_against_wheels_and_vehicle() -> None:
    p = DESIGN.Parameters(c_slip=5e6)
    M = p.m * p.r**2 / p.i**2
    rigid = sqrt(p.C * (1.0 / p.J_1 + 1.0 / (p.J_2 + M))) / (2.0 * pi)
    assert oscillation(DESIGN, p).frequency == pytest.approx(rigid, rel=0.01)


@together("plant", [DESIGN, DETAILED])
def test_the_mode_is_one_of_the_linear_plant_of_the_analysis(plant: ContinuousBlock) -> None:
    """Which has the motor in it, and more of the tyres' bend at its torque."""
    found = oscillation(plant, plant.Parameters())
    poles = np.linalg.eigvals(linear_plant(Point(plant, v=SPEED, T=27.0)).A)
    s = min(poles, key=lambda s: abs(abs(s) - 2.0 * pi * found.frequency))
    assert found.frequency == pytest.approx(abs(s) / (2.0 * pi), rel=2e-3)
    assert found.damping_ratio == pytest.approx(-s.real / abs(s), rel=0.03)


def test_ripple_ice_and_gap_are_of_no_account() -> None:
    usual = oscillation(DETAILED, DETAILED.Parameters())
    other = oscillation(DETAILED, DETAILED.Parameters(r_6b=0.2, mu=0.05, phi_B=0.5))
    assert other == pytest.approx(usual, rel=1e-6)


@together("factor", [0.1, 0.3, 3.0, 30.0])
def test_neither_pitch_nor_mounts_are_taken_for_the_drive_train(factor: float) -> None:
    """It gets faster with stiffer shafts, up to what the tyres let it."""
    p = DETAILED.Parameters()
    found = [
        oscillation(DETAILED, p._replace(k_s=f * p.k_s, k_g=f * p.k_g, k_p=f * p.k_p)).frequency
        for f in (factor, 1.1 * factor)
    ]
    assert 2.5 < found[0] < found[1] < 12.5


@together("plant", [DESIGN, DETAILED])
def test_behind_a_heavy_motor_what_rolls_out_is_not_taken_for_the_oscillation(plant: ContinuousBlock) -> None:
    """The speed of a motor of 1.65 kg.m2 shows the rolling vehicle more than the swing."""
    p = plant.Parameters()
    found = oscillation(plant, p._replace(J_1=30.0 * p.J_1))
    assert 1.0 < found.frequency < 3.0
    assert found.damping_ratio < 0.3

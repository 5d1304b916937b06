"""The main job on a part of its cases."""

import csv
from shutil import copy
from typing import Any

import pytest
from fmutesting.foreign import tampered

import driveline
from driveline.harness.loop.places import PLACES, PLANTS
from driveline.harness.loop.resolved import as_given
from driveline.harness.studies.compare import side_by_side
from driveline.harness.studies.compare.compare import (
    Outcome,
    cases,
    drawn,
    loops_of,
    run_cases,
    write_tables,
)
from fmuloop import many_runs
from toolground.errors import UserError

OURS = PLACES["controller"][0]


def test_runs_without_and_with_damping_are_neighbours():
    todo = cases(["A", "folder/B.fmu"], ["drive", "creep"], ["Ours", "folder/mine.fmu"])
    assert [case.file_name for case in todo] == [
        "A_drive_off", "A_drive_Ours", "A_drive_mine", "A_creep_off", "A_creep_Ours", "A_creep_mine",
        "B_drive_off", "B_drive_Ours", "B_drive_mine", "B_creep_off", "B_creep_Ours", "B_creep_mine",
    ]  # fmt: skip


def test_each_manoeuvre_has_a_figure_but_five_of_the_usual_ten():
    metrics: Any = None
    results: Any = None
    names = ["tipin15", "tipin15r", "creep", "drive", "prbs", "hill_start", "regen"]
    runs = drawn(Outcome(each, metrics, results) for each in cases(["A"], names, ["B"]))
    assert [each[0].case.manoeuvre for each in runs] == ["tipin15", "drive", "hill_start", "regen"]


def test_plants_and_manoeuvres_of_the_same_name_are_refused():
    with pytest.raises(UserError, match="two plants are called A"):
        cases(["A", "folder/A.fmu"], ["drive"], ["B"])
    with pytest.raises(UserError, match="two controllers are called B"):
        cases(["A"], ["drive"], ["B", "folder/B.fmu"])
    with pytest.raises(UserError, match=r"without damping is called off, .* rename the file off\.fmu"):
        cases(["off"], ["drive"], ["B", "off.fmu"])
    with pytest.raises(UserError, match="there is no controller to compare"):
        cases(["A"], ["drive"], [])
    slow, fast = (driveline.composed("tip", duration=1.0, T_driver=torque) for torque in (1.0, 2.0))
    with pytest.raises(UserError, match="two manoeuvres are called tip; rename one"):
        driveline.compare([slow, fast])


def test_a_program_gets_the_metrics_of_each_run_by_what_it_was(native, tmp_path):
    tipin = driveline.MANOEUVRES["tipin15"]
    settings = {"folder": native.parent, "seed": 2}
    controllers = [OURS, copy(native / f"{OURS}.fmu", tmp_path / "Mine.fmu")]
    found = driveline.compare([tipin], ["TwoMassDriveline"], controllers, **settings)
    assert list(found) == [("TwoMassDriveline", "tipin15", str(name)) for name in ("without damping", *controllers)]
    runs = {
        case: driveline.simulate(
            tipin,
            case.plant,
            controller=case.controller if case.control else controllers[0],
            control=case.control,
            **settings,
        )
        for case in found
    }
    expected = {case: driveline.evaluate(results, tipin) for case, results in runs.items()}
    assert driveline.frame(found).equals(driveline.frame(expected))


def test_a_mapping_is_for_the_controllers_that_have_its_names(native, tmp_path, monkeypatch):
    theirs = tampered(native / f"{OURS}.fmu", tmp_path / "Mine.fmu", lambda xml: xml.replace('"T_ref"', '"out"'))

    def mappings(todo, loops):
        return [{case: loops[case.plant, case.controller].settings.mapping} for case in todo]

    monkeypatch.setattr(side_by_side, "run_many", lambda *a, runs, **_: mappings(a[1], runs.keywords["loops"]))
    tipin, given = driveline.MANOEUVRES["tipin15"], {"folder": native.parent}
    blocks = ["TwoMassDriveline"], [OURS, theirs]
    found = driveline.compare([tipin], *blocks, mapping={"controller.T_ref": "out"}, **given)
    assert list(found.values()) == [{}, {}, {"controller.T_ref": "out"}]
    monkeypatch.setattr(side_by_side, "run_many", None)
    with pytest.raises(UserError, match=r"in Mine\.fmu nowhere does not exist"):
        driveline.compare([tipin], *blocks, mapping={"controller.T_ref": "nowhere"}, **given)


@pytest.mark.parametrize("own", ["plant", "control", "controller", "gearbox"])
def test_what_is_not_to_be_set_for_all_runs_is_refused_before_any_of_them(own):
    changes: Any = {own: "TwoMassDriveline"}
    with pytest.raises(TypeError, match=own):
        driveline.compare([], **changes)


@pytest.fixture(scope="module")
def compared(native, tmp_path_factory):
    """Folder with what a comparison of one step on both plants writes."""
    folder = tmp_path_factory.mktemp("compare")
    loops = loops_of({(plant, OURS): as_given(plant, folder=native.parent) for plant in PLANTS})
    asked: list[int] = []
    run_many = many_runs.run_many
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(many_runs, "run_many", lambda *a, **k: asked.append(len(a[1])) or run_many(*a, **k))
        outcomes, figures = run_cases(cases(PLANTS, ["tipin15"], [OURS]), folder, loops)
    assert asked == [4, 2]  # every case by itself, so that all processes have some
    assert figures == [folder / f"{plant}_tipin15.png" for plant in PLANTS]
    write_tables(outcomes, folder)
    return folder


def test_damping_settles_the_tip_in_on_both_plants(compared):
    with (compared / "metrics.csv").open(newline="", encoding="utf-8") as file:
        rows = {(row["plant"], row["control"]): row for row in csv.DictReader(file)}
    assert len(rows) == 4
    names = {path.relative_to(compared).as_posix() for path in compared.rglob("*") if path.is_file()}
    assert {"table.md", "metrics.csv"} <= names
    for plant in PLANTS:
        off, on = rows[plant, "0"], rows[plant, "1"]
        assert float(on["settling_time_s"]) < 0.4 * float(off["settling_time_s"])
        assert float(on["gear_torque_rms_N_m"]) < 0.5 * float(off["gear_torque_rms_N_m"])
        assert abs(float(on["stationary_torque_change_N_m"])) < 0.2
        assert float(off["added_torque_peak_N_m"]) == 0.0
        assert {f"{plant}_tipin15.png"} <= names
        assert {f"runs/{plant}_tipin15_{control}.csv" for control in ("off", OURS)} <= names
    # without damping the design model rings as in the reference study
    off, study = rows[PLANTS[0], "0"], {"settling_time_s": 1.758, "overshoot_1": 1.16, "gear_torque_rms_N_m": 26.5}
    study |= {"jerk_rms_to_50_Hz_m_per_s3": 24.8, "withheld_time_s": 0.0}
    assert {name: float(off[name]) for name in study} == pytest.approx(study, rel=0.03, abs=1e-9)
    # the coupled FMUs exchange their signals once a millisecond, the study integrated them together
    assert float(off["response_delay_s"]) == pytest.approx(0.044, abs=0.005)

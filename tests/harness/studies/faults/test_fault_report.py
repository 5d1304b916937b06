"""What a campaign leaves behind, and a case that is run again."""

import csv
import json
import re
from dataclasses import replace
from math import inf, isnan, nan

import numpy as np
import pytest

from driveline.harness.commands import faults
from driveline.harness.commands.cli import main
from driveline.harness.simulation.case_archive import CaseArchive
from driveline.harness.studies.faults import fault_injection
from driveline.harness.studies.faults.fault_campaign import Outcome, campaign, table
from driveline.harness.studies.faults.fault_cases import PLANS, Fault, case
from driveline.harness.studies.faults.fault_catalogue import IN_SITUATIONS
from driveline.harness.studies.faults.fault_figures import case_panels
from driveline.harness.studies.faults.fault_report import announce, write, write_case
from driveline.harness.studies.faults.judges import JUDGES
from fmuloop.runs import run
from tests.harness.commands import given
from toolground.errors import UserError

PLANTS = ("TwoMassDriveline", "ValidationVehicle")


@pytest.fixture(scope="module")
def outcomes(injector, loops):
    return campaign(fault_injection.FaultRunner(injector, loops), range(1, 7), 1, workers=1)


def test_every_case_and_what_was_measured_is_in_the_csv_file(outcomes, tmp_path):
    archive = CaseArchive(tmp_path / "faults.csv", table(1, PLANTS))
    odd = replace(outcomes[5], measured=outcomes[5].measured | {"limited": inf, "rms": nan})
    for outcome in (*outcomes[:5], odd):
        archive[outcome.case] = outcome
    with (tmp_path / "faults.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["number"] for row in rows] == ["1", "2", "3", "4", "5", "6"]
    assert [row["clean"] for row in rows] == [str(int(not outcome.failed)) for outcome in (*outcomes[:5], odd)]
    assert [bool(row["fault_2"]) for row in rows] == [False, False, True, True, False, False]
    *back, last = CaseArchive(tmp_path / "faults.csv", table(1, PLANTS)).values()
    assert back == outcomes[:5]
    assert last.measured["limited"] == inf
    assert isnan(last.measured["rms"])
    with pytest.raises(UserError, match="line 2: it must have the case of its number and what was measured"):
        CaseArchive(tmp_path / "faults.csv", table(2, PLANTS))


@pytest.mark.slow
def test_the_figures_of_a_campaign_are_drawn(outcomes, tmp_path):
    files = write(outcomes, tmp_path)
    assert {file.stem for file in files} == {"faults", "fault_pairs"}
    assert all(file.is_file() for file in files)


def test_the_figure_of_a_case_names_the_causes_that_were_found():
    names = ("faults.omega_2_can", "faults.omega_1_meas", "plant.omega_1", "plant.T_gear", "controller.T_damp")
    types = [(name, float) for name in ("time", *names, "controller.status", "controller.cause")]
    run = np.ones(3, dtype=types)
    run["controller.cause"] = 1, 4, 1
    *others, panel = case_panels(case(1, 1, PLANTS), fault_injection.Runs(run, run, run))
    assert (panel.label, panel.ticks) == ("cause", {1.0: "none", 4.0: "speed frozen"})
    bare = run[[name for name in run.dtype.names or () if name != "controller.cause"]]
    assert len(case_panels(case(1, 1, PLANTS), fault_injection.Runs(bare, bare, bare))) == len(others)


def test_the_terminal_shows_what_is_not_clean_alone(outcomes, capsys):
    clean, bad = (
        [replace(outcome, measured=dict.fromkeys(outcome.measured, value)) for outcome in outcomes]
        for value in (-1e6, 1e6)
    )
    announce(clean)
    assert capsys.readouterr().out.startswith(f"{len(clean)} cases, {len(clean)} clean, 0 not clean\n")
    announce([bad[0], *clean[1:]])
    message = capsys.readouterr().out
    assert f"{len(clean)} cases, {len(clean) - 1} clean, 1 not clean\n" in message
    assert [kind for kind in IN_SITUATIONS if f" {kind} " in message.partition(" cases, ")[0]] == [
        kind for kind in IN_SITUATIONS if kind in bad[0].kinds
    ]
    announce([replace(outcomes[0], measured=dict.fromkeys(outcomes[0].measured, -72.0))])
    assert "not clean is what is above its limit; what is below 0 stays within by so much" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("name", "size"),
    [
        ("motor speed spikes", "2 rad/s"),
        ("frame late", "2 s"),
        ("wheel lock on ice", "2 N.m"),
        ("wheel speed gain", "2"),
    ],
)
def test_a_size_has_its_unit(name, size):
    assert str(Fault(name, 1.0, 2.0, 2.0, 1.0)) == f"{name} (size {size}) from 1.000 to 2.000 s"


def _clean(numbers, plan, plants=PLANTS):
    return [Outcome(case(k, 1, plants, plan), {judge.name: -1e6 for judge in JUDGES}) for k in numbers]


def test_a_few_cases_say_which_kinds_no_case_has_alone(capsys):
    few = _clean(range(1, 51), PLANS["dry"])
    announce(few)
    said = " ".join(capsys.readouterr().out.split())
    assert said.endswith("Single faults are of 3 of 35 kinds.")


@pytest.mark.parametrize("plants", [PLANTS, PLANTS[:1]])
@pytest.mark.parametrize("plan", PLANS.values(), ids=PLANS)
def test_the_help_tells_how_many_cases_have_every_kind_in_every_situation(plan, plants, capsys):
    enough = 2 * len(plan.kinds) * len(plan.situations) * len(plants)
    assert re.search(rf"\b{enough}\b", faults.__doc__ or "")
    outcomes = _clean(range(1, enough + 1), plan, plants)
    alone = {(o.case.faults[0].name, o.case.situation, o.plant) for o in outcomes if len(o.case.faults) == 1}
    assert len(alone) == len(plan.kinds) * len(plan.situations) * len(plants)
    announce(outcomes)
    assert capsys.readouterr().out == f"{enough} cases, {enough} clean, 0 not clean\n"


@pytest.mark.parametrize(
    ("options", "caption"),
    [
        ([], ""),
        (["--campaign", "dry", "--seed", "3"], "--seed 3"),
        (["--campaign", "roads", "--seed", "3"], "--campaign roads --seed 3"),
    ],
)
def test_the_figure_of_a_case_names_its_campaign(options, caption):
    assert faults.case_caption(given("faults", *options)) == caption


@pytest.mark.slow
def test_a_case_that_is_run_again_measures_the_same(outcomes, injector, loops, tmp_path, monkeypatch):
    runs = []
    monkeypatch.setattr("fmuloop.campaign.run", lambda *given: runs.append(1) or run(*given))
    again, files = write_case(2, 1, fault_injection.FaultRunner(injector, loops), tmp_path)
    assert len(runs) == 3
    assert again == outcomes[1]
    assert [file.name for file in files] == ["case_2.csv", "case_2.png"]


@pytest.mark.slow
def test_results_tell_what_made_them_and_nothing_else_is_written(native, tmp_path, capsys):
    fmus, output = native.parent, tmp_path / "results"
    before = set(fmus.rglob("*.fmu"))
    plant = ["--plant", "TwoMassDriveline", "--fmus", str(fmus)]
    given = ["faults", "--case", "2", *plant, "--output", str(output), "--quiet"]
    assert main(given) in (0, 1)
    assert set(fmus.rglob("*.fmu")) == before
    record = json.loads((output / "case_2.json").read_text(encoding="utf-8"))
    assert (record["run"]["case"], record["run"]["TwoMassDriveline"]["seed"]) == (2, 1)
    assert record["fmus"]["TwoMassDriveline"]["faults"]["digest"].startswith("sha256:")
    assert main([*given, "--seed", "2"]) == 2
    assert (
        "seed: 1 there, 2 here); give another folder as --output, or --replace to overwrite it"
        in capsys.readouterr().err
    )


def test_so_many_cases_are_run_from_the_first_on(native, tmp_path, monkeypatch):
    numbers = []

    def campaign(_, cases, *__, **___):
        numbers.extend(cases)
        raise UserError("that is enough")

    monkeypatch.setattr("driveline.harness.studies.faults.fault_campaign.campaign", campaign)
    given = ["--plant", "TwoMassDriveline", "--fmus", str(native.parent), "--output", str(tmp_path)]
    assert main(["faults", "--cases", "3", *given]) == 2
    assert numbers == [1, 2, 3]

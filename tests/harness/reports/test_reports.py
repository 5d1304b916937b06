"""The table of the main job, and the figures."""

import csv
import io
import math
from dataclasses import fields

import numpy as np
import pytest
from rich.console import Console

from harness.manoeuvres.catalogue import MANOEUVRES
from harness.metrics.evaluate import Metrics
from harness.reports.figures import plot_drive, plot_replay, plot_step
from harness.reports.table import SHOWN, Row, cells, terminal_table, write_markdown, write_metrics


def metrics(**values):
    return Metrics(**({field.name: math.nan for field in fields(Metrics)} | values))


OFF = Row("Plant", "tipin15", False, metrics(ts=1.758, OS=1.16, bTg=26.5, dT_stat=-1e-9))
ON = Row("Plant", "tipin15", True, metrics(ts=0.114, OS=0.19, loss=0.012))


def test_a_row_shows_milliseconds_and_percent():
    shown = dict(zip([s.metric for s in SHOWN], cells(OFF)[2:], strict=True))
    assert (shown["ts"], shown["OS"], shown["bTg"]) == ("1758", "116", "26.5")
    assert cells(ON)[:2] == ["tipin15", "on"]


def test_what_has_no_meaning_is_a_dash_and_a_rounded_zero_has_no_sign():
    shown = dict(zip([s.metric for s in SHOWN], cells(OFF)[2:], strict=True))
    assert shown["t90"] == "-"
    assert shown["dT_stat"] == "0.00"


def test_the_terminal_table_names_plant_units_and_runs():
    text = io.StringIO()
    Console(width=200, file=text).print(terminal_table([OFF, ON]))
    assert all(part in text.getvalue() for part in ("Plant", "tipin15", "ms", "N.m", "1758", "114"))


def test_markdown_has_one_line_a_run(tmp_path):
    path = tmp_path / "table.md"
    write_markdown([OFF, ON], path)
    lines = path.read_text(encoding="utf-8").splitlines()
    assert len(lines) == 4
    assert len({line.count("|") for line in lines}) == 1


def test_the_csv_file_has_all_metrics_in_si_units(tmp_path):
    path = tmp_path / "metrics.csv"
    write_metrics([OFF, ON], path)
    with path.open(newline="", encoding="utf-8") as file:
        off, on = csv.DictReader(file)
    assert float(off["ts"]) == 1.758
    assert off["t90"] == ""
    assert (on["control"], float(on["loss"])) == ("1", 0.012)
    assert set(off) == {"plant", "manoeuvre", "control", *(field.name for field in fields(Metrics))}


@pytest.fixture(scope="module")
def results():
    """Signals of two seconds that look like a step."""
    t = np.arange(2001) * 1e-3
    names = (
        "time", "controller.T_driver", "controller.T_ref", "controller.T_damp", "controller.T_gear_hat",
        "motor.T_mot", "plant.T_gear", "plant.T_rim", "plant.omega_1", "plant.omega_2",
        "plant.omega_wheel_L", "plant.omega_wheel_R", "plant.v",
    )  # fmt: skip
    results = np.zeros(len(t), dtype=[(name, float) for name in names])
    results["time"] = t
    results["plant.T_gear"] = np.where(t < 1.0, 0.0, 50.0 + 50.0 * np.exp(-t) * np.sin(50.0 * t))
    results["plant.omega_2"] = 90.0
    results["plant.omega_wheel_L"] = results["plant.omega_wheel_R"] = 10.0
    return results


@pytest.mark.parametrize(("plot", "name"), [(plot_drive, "drive"), (plot_step, "tipin15")])
def test_the_same_runs_give_the_same_figures(plot, name, results, tmp_path):
    files = [plot([results, results], MANOEUVRES[name], "Plant", tmp_path / part / "run") for part in "ab"]
    for first, second in zip(*files, strict=True):
        assert first.read_bytes() == second.read_bytes()
    assert {file.suffix for file in files[0]} == {".png", ".pdf"}


def test_a_replay_shorter_than_the_close_up_is_drawn(results, tmp_path):
    recorded = (np.array([0.0, 2.0]), np.array([1.0, 2.0]))
    assert all(file.exists() for file in plot_replay([results, results], recorded, "drive", tmp_path / "run"))

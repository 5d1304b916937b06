"""Files that a click saves."""

from dataclasses import replace
from pathlib import Path

import pytest

from driveline.fmus.building.parameter_files import read_parameters, read_vehicle
from driveline.harness.cosimulation.runs import kept_loaded
from driveline.harness.explorer.request import Request
from driveline.harness.explorer.request_runs import RequestRunner
from driveline.harness.explorer.saving import save_files, save_report
from driveline.harness.loop.settings import Settings


@pytest.fixture
def runner(both_built: Path) -> RequestRunner:
    settings = Settings(folder=both_built, build="native")
    return RequestRunner({("TwoMassDriveline", "DampingController"): settings}, {"J_1": 0.06, "k_s": 3e4})


REQUEST = Request("TwoMassDriveline", "tipin15", car={"phi_B": 0.3, "m": 2000.0}, gains={"k_d": 2.0})


def test_other_commands_read_the_files_and_what_was_given_at_the_start_is_in_them(
    runner: RequestRunner, tmp_path: Path
) -> None:
    car, gains = save_files(runner, REQUEST, {"L_phi": -0.007, "k_d": 9.0}, tmp_path)
    assert read_vehicle(car) == {"J_1": 0.06, "k_s": 3e4, "m": 2000.0, "phi_B": 0.3}
    read = read_parameters(gains)
    assert read["k_d"] == 2.0
    assert read["L_phi"] == -0.007
    assert "rad, half the backlash" in car.read_text(encoding="utf-8")


def test_shafts_that_were_given_go_where_the_stiffness_is_turned(runner: RequestRunner, tmp_path: Path) -> None:
    """They would contradict it."""
    car, _ = save_files(runner, replace(REQUEST, car={"C": 150.0}), {}, tmp_path)
    assert read_vehicle(car) == {"J_1": 0.06, "C": 150.0}


def test_the_gains_of_a_character_are_those_that_ran(runner: RequestRunner, tmp_path: Path) -> None:
    request = replace(REQUEST, character=1.0)
    _, gains = save_files(runner, request, {}, tmp_path)
    ran = runner.parameters(request, "DampingController")
    assert read_parameters(gains)["k_d"] == pytest.approx(ran["controller.k_d"], rel=1e-5)


def test_no_file_is_replaced(runner: RequestRunner, tmp_path: Path) -> None:
    (tmp_path / "gains_1.toml").write_text("mine", encoding="utf-8")
    assert [path.name for path in save_files(runner, REQUEST, {}, tmp_path)] == ["car_2.toml", "gains_2.toml"]
    assert [path.name for path in save_files(runner, REQUEST, {}, tmp_path)] == ["car_3.toml", "gains_3.toml"]


def test_the_report_tells_the_car_and_the_gains(runner: RequestRunner, tmp_path: Path) -> None:
    with kept_loaded():
        page = save_report(runner, runner.answer(REQUEST), [None], tmp_path)
    text = page.read_text(encoding="utf-8")
    assert page.name == "report_1.html"
    assert "request car phi_B" in text
    assert "in 1 of 1 runs" in text

"""`driveline identify`: from a recording to the parameters of the car and to a controller for it."""

import json
import sys
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from fmpy import read_model_description
from matplotlib.figure import Figure

from driveline.fmus.building.parameter_files import read_parameters, read_vehicle
from driveline.harness.commands.cli import main
from driveline.harness.design import redesign
from driveline.harness.design.design import design
from driveline.harness.design.design_weights import PLANT
from driveline.harness.identification import prior_knowledge
from driveline.harness.identification.identify import Identified
from driveline.harness.loop.settings import Settings
from driverecords.measurement import read_measurement
from tests.harness.commands import Capsys

FILES = {"car.toml", "car_identified.json", "car.json", "car.png"}

Identify = Callable[..., int]


@pytest.fixture(scope="module")
def recording(both_built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """4 s of the design model."""
    folder = tmp_path_factory.mktemp("recorded")
    assert main(["record", "--duration", "4", "--fmus", str(both_built), "--output", str(folder), "--quiet"]) == 0
    return folder / "TwoMassDriveline_prbs_off.csv"


@pytest.fixture
def identify(recording: Path, tmp_path: Path) -> Identify:
    """Runs the command on the recording, into tmp_path/out."""
    return lambda *more: main(["identify", str(recording), "--output", str(tmp_path / "out" / "car.toml"), *more])


def found(folder: Path) -> dict:
    return json.loads((folder / "car_identified.json").read_text(encoding="utf-8"))


def require_close(document: dict, name: str, true: float, relative: float) -> None:
    """Within four standard deviations, which are small."""
    deviation = document["standard_deviations"][name]
    assert abs(document["parameters"][name] - true) < 4.0 * deviation, name
    assert deviation < relative * true, name


@pytest.mark.slow
def test_the_car_is_found_and_all_files_are_there_and_a_second_run_makes_the_same(
    identify: Identify, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capsys
) -> None:
    """What the figures show, and that they remain the same, is tested with them; here they are drawn but not saved."""
    monkeypatch.setattr(Figure, "savefig", lambda _, path, **__: path.write_bytes(b"a figure"))
    folder = tmp_path / "out"
    assert identify() == 0
    message = capsys.readouterr().out
    assert {path.name for path in folder.iterdir()} == FILES
    written = {str(folder / name) for name in FILES}
    assert {line.split(": ")[1] for line in message.splitlines() if line.startswith("written")} == written
    assert "identified with load torque: J_2 is that of the wheels alone, C that" in message
    assert "warning" not in message
    document = found(folder)
    for name, true, relative in (("J_2", PLANT.J_2, 2e-2), ("C", PLANT.C, 1e-3), ("phi_B", PLANT.phi_B, 3e-3)):
        require_close(document, name, true, relative)
    assert document["torque_loop"]["tau"] == pytest.approx(0.003, rel=0.01)
    assert document["fit"]["omega_1"] > 98.0
    assert read_vehicle(folder / "car.toml").keys() == {"C", "J_2", "phi_B", "tau"}
    assert json.loads((folder / "car.json").read_text(encoding="utf-8"))["files"]

    monkeypatch.setattr("driveline.harness.commands.identify.draw", lambda *_: [])
    before = {name: (folder / name).read_bytes() for name in ("car.toml", "car_identified.json")}
    assert identify("--quiet") == 0
    assert capsys.readouterr() == ("", "")
    assert {name: (folder / name).read_bytes() for name in before} == before

    assert identify("--free", "J_1") == 2, "another run"
    assert "car.toml is of another run (free" in capsys.readouterr().err
    assert {name: (folder / name).read_bytes() for name in before} == before


@pytest.fixture(scope="module")
def answer(recording: Path) -> Identified:
    """What the search finds in the recording."""
    return prior_knowledge.identify(read_measurement(recording, PLANT.i, PLANT.r))


@pytest.fixture
def without_search(answer: Identified, monkeypatch: pytest.MonkeyPatch) -> None:
    """The command is given what the search finds."""
    monkeypatch.setattr(prior_knowledge, "identify", lambda *_: answer)


@pytest.fixture
def without_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """They are drawn in another test."""
    monkeypatch.setattr("driveline.harness.commands.identify.draw", lambda *_: [])


def test_without_casadi_the_extra_is_named(identify, tmp_path, monkeypatch, capsys) -> None:
    monkeypatch.setitem(sys.modules, "casadi", None)
    assert identify() == 2
    assert "identifying a model needs the package casadi: install the extra `identification`" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_without_load_torque_and_demand_the_result_has_another_name(
    recording: Path, tmp_path: Path, capsys: Capsys, without_figures: None
) -> None:
    path = tmp_path / "less.csv"
    table = pd.read_csv(recording).drop(columns=["Wheel Torque [N.m]", "Torque Demand [N.m]"])
    table.to_csv(path, index=False)
    assert main(["identify", str(path), "--output", str(tmp_path / "car.toml")]) == 0
    assert "identified effective, without load torque" in capsys.readouterr().out
    document = found(tmp_path)
    assert document["torque_loop"] is None
    assert document["tyre"] is None
    assert document["parameters"]["J_2"] > 2.0 * PLANT.J_2, "the vehicle is in it"
    assert read_vehicle(tmp_path / "car.toml").keys() == {"C", "phi_B"}


@pytest.mark.slow
def test_the_vehicle_file_is_what_is_known(identify, tmp_path, capsys, without_figures) -> None:
    """Its J_1, 3 % wrong, is doubted; its other entries stay."""
    car = tmp_path / "known.toml"
    car.write_text(f"J_1 = {1.03 * PLANT.J_1}\nC = 100.0\nm = 1450.0\n", encoding="utf-8")
    assert identify("--vehicle", str(car)) == 0
    message = capsys.readouterr().out
    assert "warning: the recorded motor torque looks 0.9" in message
    assert f"or J_1 = {1.03 * PLANT.J_1:g} kg.m2 should be 0.05" in message
    entries = read_vehicle(tmp_path / "out" / "car.toml")
    assert entries.keys() == {"J_1", "J_2", "C", "m", "phi_B", "tau"}
    assert (entries["J_1"], entries["m"]) == (1.03 * PLANT.J_1, 1450.0)
    assert "g_T" in found(tmp_path / "out")["free"]


@pytest.mark.slow
def test_stopped_while_figures_are_drawn_it_leaves_no_vehicle_file(
    identify, without_search, tmp_path, monkeypatch
) -> None:
    def stopped(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Figure, "savefig", stopped)
    assert identify("--quiet") == 130
    assert [path for path in (tmp_path / "out").rglob("*") if path.is_file()] == []


@pytest.mark.slow
def test_design_writes_gains_and_both_builds_and_compares(
    identify: Identify,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capsys,
    without_search: None,
    without_figures: None,
    native_builder: object,
) -> None:
    calls = []

    def worth(plant: str, manoeuvre: str, car: dict, assumed: dict, settings: Settings) -> tuple[float, float]:
        calls.append((car, settings))
        return (0.123, 0.045) if "k_d" in assumed else (0.234, 0.056)

    monkeypatch.setattr(redesign, "worth", worth)
    kept = Settings(folder=tmp_path / "kept")
    monkeypatch.setattr("driveline.harness.commands.redesign.built_together", lambda _: [kept])
    assert identify("--design") == 0
    folder = tmp_path / "out"
    car, gains = read_vehicle(folder / "car.toml"), read_parameters(folder / "car_gains.toml")
    assert gains == pytest.approx(design(car), rel=1e-5)
    fmus = [folder / "car_fmus" / where / "DampingController.fmu" for where in (".", "native")]
    for fmu in fmus:
        start = {variable.name: str(variable.start) for variable in read_model_description(str(fmu)).modelVariables}
        assert float(start["k_d"]) == pytest.approx(gains["k_d"])
        assert float(start["C"]) == pytest.approx(car["C"])
    files = json.loads((folder / "car.json").read_text(encoding="utf-8"))["files"]
    assert {"car_fmus/DampingController.fmu", "car_fmus/native/DampingController.fmu"} < files.keys()
    lines = capsys.readouterr().out.splitlines()
    assert next(line for line in lines if "to drive with them" in line).endswith(" --output results/car")
    message = "\n".join(line for line in lines if any(f" {name} " in line for name in redesign.REDESIGN_MANOEUVRES))
    assert message.count("234") == message.count("123") == message.count("5.6") == message.count("4.5") == 8
    assert all(of == car and settings is kept for of, settings in calls)


def test_a_short_recording_is_refused_before_the_search(recording, tmp_path, capsys) -> None:
    path = tmp_path / "short.csv"
    path.write_text("".join(recording.read_text(encoding="utf-8").splitlines(keepends=True)[: 1 + 1251]))
    assert main(["identify", str(path), "--output", str(tmp_path / "out" / "car.toml")]) == 2
    assert "short is 2.5 s long; 2.8 s or more" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_a_car_that_is_hardly_known_is_told_but_not_written(
    identify, without_search, tmp_path, monkeypatch, capsys
) -> None:
    monkeypatch.setattr("driveline.harness.identification.car_file.WIDEST_INTERVAL", 1e-6)
    assert identify() == 2
    message = capsys.readouterr()
    assert "  C       = 117" in message.out
    (line,) = message.err.splitlines()
    assert line.startswith("driveline identify: C of the car = 117 +- 0.")
    assert line.endswith("excite more or longer, and give every channel as it was sampled")
    assert not (tmp_path / "out").exists()


def test_files_of_another_origin_are_not_replaced(identify: Identify, tmp_path: Path, capsys: Capsys) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    for name in ("car.toml", "car_identified.json"):
        (folder / name).write_text("mine")
        assert identify() == 2
        assert f"{folder / name} is there" in capsys.readouterr().err
        assert (folder / name).read_text() == "mine"
        (folder / name).unlink()

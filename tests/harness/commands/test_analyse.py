"""`driveline analyse` says what is wrong in one line, and writes tables and figures."""

import json
import re
from math import inf, nan
from pathlib import Path

import pytest

from driveline.harness.commands.analyse import finite
from driveline.harness.commands.cli import main
from driveline.harness.loop.own_controller import with_equations
from driveline.harness.metrics.estimate import EstimateMetrics
from driveline.harness.studies.margins.analysis_report import announce, write
from driveline.harness.studies.margins.describing_function import LimitCycle, Swing
from driveline.harness.studies.margins.loop_analysis import Analysis, Part, linear_part
from driveline.harness.studies.margins.parameter_sweeps import SWEEPS, Swept
from driveline.harness.studies.margins.sensitivity import SHOWN, Sensitivity
from tests.harness.commands import Capsys
from toolground.errors import UserError

PLANT = "TwoMassDriveline"


@pytest.fixture(scope="module")
def found() -> Analysis:
    """Of one plant at one speed; the loop is the same for all values and amplitudes."""
    at = linear_part(Part(PLANT, "15"), "SpeedWashout", {PLANT: {"plant.C": 100.0}})
    same = Swept(1.0, at.loop.closed().diagonal() + 0.5j, at.mode, at.margins)
    return Analysis(
        "SpeedWashout",
        [at],
        {PLANT: {sweep.name: [same, same._replace(margins=None)] for sweep in SWEEPS}},
        {PLANT: [Swing(1.2, 0.08, False, None), Swing(inf, 1.0, True, at.margins)]},
        {PLANT: [LimitCycle(1.5, 0.22, 2.5, True)]},
        {(PLANT, "tipin15"): EstimateMetrics(nan, nan, nan, nan, {"bias": "the controller estimates no twist"})},
        [Sensitivity(PLANT, "tipin15", "plant.C", dict.fromkeys(SHOWN, 0.5) | {"overshoot": nan})],
    )


@pytest.mark.slow
def test_tables_and_figures_are_written_and_limit_cycles_are_told(found, tmp_path, capsys) -> None:
    files = write(found, tmp_path)
    assert all(file.is_file() for file in files)
    assert (tmp_path / "margins.csv").read_text(encoding="utf-8").splitlines()[1].startswith(f"{PLANT},15,")
    announce(found)
    assert "one that lasts, 1.50 φ_B at 2.5 Hz (N = 0.22)" in " ".join(capsys.readouterr().out.split())


def test_the_document_has_nothing_that_json_does_not_know(found: Analysis) -> None:
    document = json.loads(json.dumps(finite(found.record), allow_nan=False))
    assert document["margins"][0]["speed_km_per_h"] == 15.0
    assert document["backlash"][1]["amplitude"] is None
    assert document["estimates"][0]["bias"] is None


def test_a_wrong_vehicle_file_and_a_loop_that_is_not_stable_are_said(tmp_path: Path, capsys: Capsys) -> None:
    car = tmp_path / "car.toml"
    car.write_text("C = -3.0\n", encoding="utf-8")
    assert main(["analyse", "--vehicle", str(car), "--output", str(tmp_path / "results")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert re.search(r"car\.toml, line 1: C = -3: .* takes 1 to 100000 N\.m/rad", line)
    assert not (tmp_path / "results").exists()
    stable, unstable = ({PLANT: {"controller.k_v": k_v, "controller.omega_v": 25.0}} for k_v in (4.0, 5.0))
    assert linear_part(Part(PLANT, "15"), "SpeedWashout", stable).margins.gain_margin > 1.0
    with pytest.raises(UserError, match=r"SpeedWashout is not stable in contact at 15 km/h: it has no margins"):
        linear_part(Part(PLANT, "15"), "SpeedWashout", unstable)


OWN = """
from dataclasses import replace
from driveline import Fmu
from driveline.models.comparators.speed_washout import BLOCK as WASHOUT
BLOCK = replace(WASHOUT, name="Mine", module=__name__)
FMU = Fmu(BLOCK, stop_time=10.0)
"""


def test_a_controller_of_the_users_own_is_analysed_by_its_equations(tmp_path: Path) -> None:
    (tmp_path / "Mine.py").write_text(OWN, encoding="utf-8")
    own, ours = (
        linear_part(Part(PLANT, "15"), name, {PLANT: {}}) for name in (str(tmp_path / "Mine.fmu"), "SpeedWashout")
    )
    assert own.margins == ours.margins
    lacks = OWN.replace('name="Mine"', 'name="Lacks", Input=replaced')
    lacks = lacks.replace("BLOCK =", "replaced = type('Input', (WASHOUT.Input,), {'_fields': ('T_driver',)})\nBLOCK =")
    (tmp_path / "Lacks.py").write_text(lacks, encoding="utf-8")
    with pytest.raises(UserError, match=r"Lacks has no omega_1_meas, .*`driveline.supervised` makes"):
        linear_part(Part(PLANT, "15"), str(tmp_path / "Lacks.fmu"), {PLANT: {}})


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("mine.fmu", "mine.fmu does not tell its equations, nor in which range .*: give the Python file"),
        ("Speedwashout", r"Speedwashout is unknown; did you mean SpeedWashout\? \(or give a Python file\)"),
        ("nothing.py", "there is no file nothing.py"),
    ],
)
@pytest.mark.parametrize("command", ["analyse", "design"])
def test_a_controller_without_equations_is_refused_in_one_line(
    command: str, name: str, message: str, tmp_path: Path, capsys: Capsys, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    search = ["--search", "folder"] if command == "design" else []
    try:
        code: object = main([command, "--controller", name, *search])
    except SystemExit as end:
        code = end.code
    first, *others = capsys.readouterr().err.splitlines()
    assert code == 2
    assert re.search(message, first)
    assert len(others) <= 1, "where the help is"


@pytest.mark.slow
def test_the_fmu_of_a_python_file_is_built_once_with_the_file_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    file = tmp_path / "my_washout.py"
    file.write_text(OWN, encoding="utf-8")
    made = Path(with_equations(str(file)))
    before = made.stat().st_mtime_ns
    assert made.with_suffix(".py").read_text(encoding="utf-8") == OWN
    assert with_equations(str(file)) == str(made)
    assert made.stat().st_mtime_ns == before
    file.write_text(f"{OWN}# another\n", encoding="utf-8")
    assert with_equations(str(file)) != str(made)
    assert with_equations("SpeedWashout") == "SpeedWashout"

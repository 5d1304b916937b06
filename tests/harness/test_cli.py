"""The command line: what it does, what it answers to mistakes, and its exit codes."""

import subprocess
import sys

import pytest
from fmpy.util import read_csv

from harness.cli import COMMANDS, main
from harness.cosimulation.system import PLANTS, loop
from tests import ROOT


def answer(capsys, *arguments):
    """Exit code and what stands on stdout and stderr."""
    try:
        code = main(arguments)
    except SystemExit as end:
        code = end.code
    return code, *capsys.readouterr()


@pytest.fixture
def plant(built):
    return str(built / f"{PLANTS[0]}.fmu")


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_teaches(capsys, command):
    code, out, _ = answer(capsys, command, "--help")
    assert code == 0
    assert "examples:" in out
    assert f"driveline {command}" in out


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (["simulat"], "did you mean simulate"),
        (["simulate", "--manoeuvre", "tipn15"], "did you mean tipin15"),
        (["simulate", "--plant", "TwoMasDriveline"], "did you mean TwoMassDriveline"),
        (["simulate", "--plnt", "x"], "did you mean --plant"),
        (["simulate", "--set", "plant.J_1"], "plant.J_1=0.06"),
        (["simulate", "--scheme", "gaus"], "gauss-seidel"),
        (["simulate", "--plot", "run.jpeg"], "does not end in .png or .pdf"),
        (["build", "TwoMass"], "did you mean TwoMassDriveline"),
        (["check", "nothing.fmu"], "there is no FMU nothing.fmu"),
        (["compare", "--manoeuvre", "launc"], "did you mean launch"),
        ([], "COMMAND"),
    ],
)
def test_a_mistake_gets_a_hint_and_exit_code_2(capsys, arguments, hint):
    code, _, err = answer(capsys, *arguments)
    assert code == 2
    assert hint in err
    assert "Traceback" not in err


def test_the_module_builds_the_named_fmu(tmp_path):
    command = [sys.executable, "-m", "harness", "build", "MotorTorqueLoop", "--build", "python"]
    done = subprocess.run([*command, "--output", str(tmp_path)], cwd=ROOT, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert [path.name for path in tmp_path.iterdir()] == ["MotorTorqueLoop.fmu"]
    assert "MotorTorqueLoop.fmu" in done.stdout


@pytest.fixture
def simulate(capsys, built, tmp_path, monkeypatch):
    """Runs `driveline simulate` on the freshly built FMUs; gives its answer and the file."""
    monkeypatch.setattr("harness.simulate.loop", lambda plant, *_: loop(plant, built))

    def run(*arguments):
        path = tmp_path / "signals.csv"
        return answer(capsys, "simulate", *arguments, "--output", str(path)), path

    return run


def test_simulate_writes_what_was_asked_for(simulate, plant):
    arguments = ("--plant", plant, "--manoeuvre", "launch", "--control", "off", "--step", "0.002", "--build", "python")
    (code, out, err), path = simulate(*arguments, "--set", "motor.sigma_omega=0", "--set", "motor.q_omega=0")
    assert (code, err) == (0, "")
    assert str(path) in out
    assert "python FMUs" in out
    signals = read_csv(path)
    assert len(signals) == 3001
    assert not signals["controller.enable"].any()
    # undisturbed, the resolver shows the speed of the plant one step earlier
    assert (signals["motor.omega_1_meas"][1:] == signals["plant.omega_1"][:-1]).all()


def test_simulate_draws_the_run(simulate, tmp_path):
    figure = tmp_path / "figures" / "run.png"
    (code, out, err), _ = simulate("--step", "0.002", "--plot", str(figure))
    assert (code, err) == (0, "")
    assert str(figure) in out
    assert figure.read_bytes().startswith(b"\x89PNG")


def test_a_refused_parameter_is_named_with_exit_code_1(simulate):
    (code, _, err), path = simulate("--set", "plant.J_1=-1")
    assert code == 1
    assert "J_1 = -1" in err
    assert not path.exists()


def test_an_unknown_parameter_is_answered_with_exit_code_2(simulate):
    (code, _, err), _ = simulate("--set", "plant.J1=0.06")
    assert code == 2
    assert "did you mean J_1" in err


def test_check_tells_findings_by_its_exit_code(capsys, built, tmp_path):
    assert answer(capsys, "check", str(built / "MotorTorqueLoop.fmu"))[0] == 0
    faulty = tmp_path / "faulty.fmu"
    faulty.write_text("no archive")
    code, out, _ = answer(capsys, "check", str(faulty))
    assert code == 1
    assert "not an FMU" in out

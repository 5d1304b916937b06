"""The command line: what it does, what it answers to mistakes, and its exit codes."""

import json
import os
import re
import subprocess
import sys
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from xml.etree import ElementTree

import pytest
from fmpy.util import read_csv
from fmutesting.foreign import build_car, tampered

from driveline.harness.commands import build
from driveline.harness.commands.cli import COMMANDS, PURPOSES, SHELLS
from driveline.harness.commands.settings import resolved
from driveline.harness.commands.target import ACTIONS
from driveline.harness.loop.places import PLACES, PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics
from tests import ROOT
from tests.harness.commands import answer, given

HARNESS = "driveline.harness"
NO_RUN = {"numpy", "scipy", "matplotlib", "fmpy", "rich", "shtab"}


@pytest.mark.parametrize("command", [*COMMANDS, *(f"target {action}" for action in ACTIONS)])
def test_every_command_teaches_on_one_screen(capsys, monkeypatch, command):
    """The options that few need, and the rest of what it says, are in --help-all."""
    monkeypatch.setenv("COLUMNS", "102")
    code, out, err = message = answer(capsys, *command.split(), "--help")
    assert message == answer(capsys, "help", *command.split())
    assert (code, err) == (0, "")
    assert out.startswith(f"usage: driveline {command} ")
    assert "examples:" in out
    assert f"driveline {command}" in out.partition("examples:")[2]
    assert len(out.splitlines()) <= 45
    if command != "target":
        code, everything, _ = answer(capsys, *command.split(), "--help-all")
        assert code == 0
        assert {line.split()[0] for line in out.splitlines() if line.startswith("  --")} <= set(everything.split())


def test_help_has_the_commands_by_what_they_are_for_and_the_exit_codes(capsys):
    for asked in (["--help"], ["help"]):
        code, out, _ = answer(capsys, *asked)
        assert code == 0
        sections = re.split(r"^(\S.*):\n", out, flags=re.M)
        listed = {
            title: set(re.findall(r"^  (\S+)", text, re.M))
            for title, text in zip(sections[1::2], sections[2::2], strict=True)
        }
        assert {title: listed[title] for title in PURPOSES} == {title: set(names) for title, names in PURPOSES.items()}
        assert "0 done, 1 something went wrong or there are findings, 2 wrong use" in out
    assert answer(capsys, "--version")[:2] == (0, f"driveline-damping {version('driveline-damping')}\n")


def test_what_experts_need_stands_in_help_all_alone(capsys):
    (_, out, _), (_, everything, _) = (answer(capsys, "simulate", option) for option in ("--help", "--help-all"))
    first, _, last = everything.partition("options for experts:")
    for option in ("--time-limit", "--unpacked-limit", "--scheme", "--build", "--fmus", "--map"):
        assert f"  {option}" in last
        assert f"  {option}" not in first + out
    assert "--manoeuvre" in first
    assert first.startswith("usage: driveline simulate [OPTION ...]\n")


@pytest.mark.parametrize("command", ["simulate", "compare", "ssp"])
def test_the_manoeuvres_are_listed_a_line_each(capsys, command):
    code, out, err = answer(capsys, command, "--list")
    assert (code, err) == (0, "")
    assert [line.split()[0] for line in out.splitlines()] == list(MANOEUVRES)
    assert out.splitlines()[0] == "tipin15         tip-in through the backlash at 15 km/h (6 s)"
    slippery = [line.split()[0] for line in out.splitlines() if line.endswith(": ValidationVehicle)")]
    assert slippery == [name for name, manoeuvre in MANOEUVRES.items() if manoeuvre.road]


@pytest.mark.parametrize("words", [["--list", "--json"], ["--json", "--list"]])
def test_the_manoeuvres_are_listed_as_one_document_for_tools(capsys, words):
    code, out, err = answer(capsys, "simulate", *words)
    assert (code, err) == (0, "")
    listed = json.loads(out)["manoeuvres"]
    assert listed[0] == {"name": "tipin15", "description": "tip-in through the backlash at 15 km/h", "duration": 6.0}
    assert [each["name"] for each in listed] == list(MANOEUVRES)


@pytest.mark.parametrize(
    ("name", "found"),
    [
        *((name, "control characters") for name in ("a\nb.csv", "a\rb.csv", "a.csv\n", "a\x1b[31mb.csv", "a\x9bb.csv")),
        ("a\u2028b.csv", "line ends"),
        ("a\udcffb.csv", "bytes that are no text"),
    ],
)
def test_an_argument_that_is_no_printable_line_is_shown_in_one_and_refused(capsys, name, found):
    expected = f"driveline: the argument {name!r} has {found}; rename the file\n"
    assert answer(capsys, "replay", name) == (2, "", expected)
    assert expected.rstrip().isprintable()


@pytest.mark.parametrize("name", ["Fahrt 1 ä [km/h].csv", "走行\u3000.csv", "a\tb.csv"])
def test_all_that_can_be_printed_may_be_an_argument(capsys, name):
    assert answer(capsys, "replay", name) == (2, "", f"driveline replay: there is no recording {name}\n")


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (["simulat"], "did you mean simulate"),
        (["simulate", "--manoeuvre", "tipn15"], "did you mean tipin15"),
        (["simulate", "--manoeuvre", ""], "an empty name is unknown"),
        (["simulate", "--plant", "TwoMasDriveline"], "did you mean TwoMassDriveline"),
        (["simulate", "--plnt", "x"], "did you mean --plant"),
        (["simulate", "--set", "plant.J_1"], "plant.J_1=0.06"),
        (["simulate", "--scheme", "gaus"], "gauss-seidel"),
        (
            ["simulate", "--set", "c.k@1=1", "--set", "c.k@1=2"],
            "--set: c.k@1 is given twice, 1.0 and 2.0; it takes one value",
        ),
        (["record", "--gain-error", "-5"], "argument --gain-error: '-5' is not a share from -0.5 to 1"),
        *((["record", "--order", order], f"'{order}' is not a whole number from 5 to 12") for order in ("4", "13")),
        (["simulate", "--seed", "1.5"], "'1.5' is not a whole number"),
        *(
            ([*command, "--seed", "1000001"], "argument --seed: '1000001' is not a whole number from 0 to 1000000")
            for command in (["simulate"], ["robustness"], ["faults"])
        ),
        (["simulate", "--step", "nan"], "'nan' is not a time above 0 s"),
        (["simulate", "--output", ""], "the name of the folder is empty"),
        (["replay", "trip.csv", "--held", "0"], "'0' is not a time above 0 s"),
        (["build", "TwoMass"], "did you mean TwoMassDriveline"),
        (["build", "nothing.py"], "there is no file nothing.py"),
        (["build", "--fmi", "3.0"], "--fmi: 3.0 is unknown; known are: 2, 3"),
        (["check", "nothing.fmu"], "there is no FMU nothing.fmu"),
        (["check", "nothing.fmu", "--json", "--format", "junit"], "--format: not allowed with argument --json"),
        (["compare", "--manoeuvre", "launc"], "did you mean launch"),
        (["--print-completion", "bsh"], "did you mean bash"),
        ([], "COMMAND"),
        (["help", "simulat"], "did you mean simulate"),
        (["target", "exprt"], "did you mean export"),
        (["study", "bound"], "study is unknown"),
        (["simulate", "--output", "run.mf4"], "is to be a folder, for all files that are written"),
        (["analyse", "--controller", "SpeedWashOut"], "SpeedWashOut is unknown; did you mean SpeedWashout?"),
        (["car", "--template", "van.toml"], "--template writes the default car"),
        (["car", "--output", "car.toml"], "--output is for a template"),
        (["car", "no.toml"], "no.toml: there is no such file"),
        (["identify", "a.csv", "--output", "car.json"], "'car.json': a vehicle file is a .toml"),
        (["identify", "a.csv", "--vehicle", "absent.toml"], "absent.toml"),
        (["identify", "a.csv", "--free", "C"], "--free: C is unknown; known are: J_1"),
        (["identify", "a.csv"], "there is no recording a.csv"),
        *(
            (["design", f"--{option}={value}"], f"--{option} is for a search: give the folder of one, --search FOLDER")
            for option, value in (("controller", "SpeedWashout"), ("evaluations", 5), ("seed", 1), ("build", "native"))
        ),
        (["design", "--search", "search", "--character=1.1"], "is not a number from 0 to 1"),
        (["design", "--search", "search", "--evaluations", "0"], "is not a whole number from 1 to 100000"),
        (["design", "--search", "search", "--controller", "Mine"], "Mine is unknown; known are: DampingController"),
    ],
)
def test_a_mistake_gets_a_hint_and_exit_code_2(capsys, monkeypatch, tmp_path, arguments, hint):
    monkeypatch.chdir(tmp_path)
    code, _, err = answer(capsys, *arguments)
    assert code == 2
    assert hint in err
    assert "Traceback" not in err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("command", "option", "values"),
    [
        ("simulate", "--manoeuvre", ("tipin15", "drive")),
        ("simulate", "--seed", ("1", "2")),
        ("robustness", "--cases", ("10", "20")),
        ("target export", "--precision", ("float", "double")),
    ],
)
def test_an_option_with_one_value_is_not_given_two(capsys, command, option, values):
    first, second = values
    code, out, err = answer(capsys, *command.split(), option, first, f"{option}={second}")
    assert (code, out) == (2, "")
    assert err.splitlines()[0] == (
        f"driveline {command}: {option} is given twice, {first!r} and {second!r}; it takes one value"
    )


def test_what_is_repeatable_keeps_all_values_and_a_record_without_words_is_that_of_a_program():
    words = ["--controller", "SpeedWashout", "--controller", "PaperObserver", "--seed", "1", "--seed", "1"]
    args = given("replay", "trip.csv", *words, "--set", "can.tau=0.1", "--set", "plant.J_1=0.06")
    assert args.controller == ("SpeedWashout", "PaperObserver")
    assert args.set == (("can.tau", 0.1), ("plant.J_1", 0.06))
    assert args.seed == 1
    # So that nothing is usual in one and not in the other.
    needed = {"replay": "recording", "identify": "recording", "check": "fmus", "again": "made", "map": "fmu"}
    for command in COMMANDS.keys() - {"target"}:
        file = Path("a.csv")
        positional = {needed[command]: (file,) if command == "check" else file} if command in needed else {}
        made = import_module(f"driveline.harness.commands.{command}").Arguments(**positional)
        assert given(command, *(["a.csv"] if positional else [])) == made
    for action, (record, *_) in ACTIONS.items():
        assert given("target", action) == record()


@pytest.mark.parametrize(
    ("statement", "without"),
    [
        *(
            (
                f"import {HARNESS}.commands.cli\ntry: {HARNESS}.commands.cli.main({words})\nexcept SystemExit: ...",
                NO_RUN,
            )
            for words in (["--help"], ["simulate", "--help"], ["simulate", "--manoeuvre", "tipn15"])
        ),
        (f"import {HARNESS}.commands.simulate, {HARNESS}.simulation.simulate", {"matplotlib", "scipy", "rich"}),
    ],
)
def test_packages_are_imported_where_they_are_needed_alone(statement, without):
    """Help and mistakes are answered without those of a run; a run draws nothing unless asked."""
    listed = f"import sys\n{statement}\nprint(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", listed], cwd=ROOT, capture_output=True, text=True, check=True)
    loaded = set(done.stdout.splitlines()[-1].split())
    assert "driveline.harness.commands" in loaded
    assert not loaded & without


@pytest.mark.parametrize("shell", SHELLS)
def test_completion_knows_commands_options_and_manoeuvres(capsys, shell):
    code, out, _ = answer(capsys, "--print-completion", shell)
    assert code == 0
    assert all(word in out for word in ("export", "manoeuvre", "time-limit", "launch_brake"))


@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("driveline sim", {"simulate"}),
        ("driveline simulate --manoeuvre tipin1", {"tipin15", "tipin15r"}),
        ("driveline replay --plant Val", {"ValidationVehicle"}),
        ("driveline check my", {"my.fmu"}),
        ("driveline simulate --plant my", {"my.fmu"}),
        ("driveline compare --motor Mot", {"MotorTorqueLoop"}),
    ],
)
def test_bash_completes_words(capsys, tmp_path, typed, offered):
    _, completion, _ = answer(capsys, "--print-completion", "bash")
    (tmp_path / "my.fmu").touch()
    (tmp_path / "complete").write_text(completion, encoding="utf-8")
    words = typed.split()
    script = f"""
source ./complete
COMP_WORDS=({typed}); COMP_CWORD={len(words) - 1}
_shtab_driveline
printf '%s\\n' "${{COMPREPLY[@]}}"
"""
    done = subprocess.run(["bash", "-c", script], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert set(done.stdout.split()) == offered


def test_build_names_what_is_there_at_its_end(capsys, monkeypatch, tmp_path):
    path = tmp_path / "made" / "MotorTorqueLoop.fmu"
    command = ["build", "MotorTorqueLoop", "--build", "python", "--output", str(path.parent)]
    assert answer(capsys, *command) == (0, f"{path}  {path.stat().st_size / 1024:.0f} kB\n", "")
    assert answer(capsys, *command, "--quiet") == (0, "", "")
    path.unlink()

    def stopped(*_):
        path.touch()
        yield path
        raise KeyboardInterrupt

    monkeypatch.setattr(build, "build_fmus", stopped)
    assert answer(capsys, *command) == (130, "", "driveline build: stopped\n")
    assert not path.exists()


@pytest.fixture
def simulate(capsys, both_built, tmp_path):
    """Runs `driveline simulate` on freshly built FMUs; gives its answer and the folder."""

    def run(*arguments):
        folder = tmp_path / "results"
        return answer(capsys, "simulate", *arguments, "--fmus", str(both_built), "--output", str(folder)), folder

    return run


@pytest.mark.slow
def test_simulate_writes_what_was_asked_for(simulate, built):
    plant = str(built / f"{PLANTS[0]}.fmu")
    arguments = ("--plant", plant, "--manoeuvre", "launch", "--control", "off", "--step", "0.002", "--build", "python")
    (code, out, err), folder = simulate(*arguments, "--set", "motor.sigma_omega=0", "--set", "motor.q_omega=0")
    assert (code, err) == (0, "")
    path = folder / "TwoMassDriveline_launch_off.csv"
    assert str(path) in out
    assert "python FMUs" in out
    signals = read_csv(path)
    assert len(signals) == 3001
    assert not signals["controller.enable"].any()
    # undisturbed, the resolver shows the speed of the plant at the same instant
    assert (signals["motor.omega_1_meas"] == signals["plant.omega_1"]).all()
    assert "plant.T_mot is held, motor.omega_1 is held" in out


def test_simulate_tells_the_metrics_of_its_run(simulate, tmp_path):
    (code, out, err), folder = simulate("--json")
    assert (code, err) == (0, "")
    document = json.loads(out)
    (run,) = document["runs"]
    assert (run["plant"], run["manoeuvre"], run["control"]) == (PLANTS[0], "tipin15", True)
    assert 0.05 < run["settling_time_s"] < 0.1
    assert document["files"] == [str(folder / "TwoMassDriveline_tipin15_DampingController.csv")]
    (code, out, _), _ = simulate()
    assert code == 0
    assert f" {1e3 * run['settling_time_s']:.0f} " in next(line for line in out.splitlines() if "tipin15    " in line)


def test_with_steps_that_miss_the_samples_of_the_controller_it_is_said_why_there_are_no_metrics(simulate):
    (code, out, _), folder = simulate("--step", "0.0015")
    assert code == 0
    reason = "the results are 1.5 ms apart; the metrics need a whole fraction"
    assert f"no metrics: {reason}" in out
    (_, out, _), _ = simulate("--step", "0.0015", "--json")
    document = json.loads(out)
    assert document["runs"] == []
    assert document["no_metrics"].startswith(reason)
    assert (folder / "TwoMassDriveline_tipin15_DampingController.csv").is_file()


def test_the_kind_of_the_figure_and_what_it_shows_are_chosen(simulate):
    said, folder = simulate("--step", "0.002", "--plot", "--window", "0.9,1.4", "--figures", "svg", "--quiet")
    assert said == (0, "", "")
    assert {path.suffix for path in folder.iterdir()} == {".csv", ".json", ".svg"}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--window", "1,2"), "--window is for the figure; ask for it with --plot"),
        (("--figures", "svg"), "--figures is for the figure; ask for it with --plot"),
        (("--plot", "--window", "7,8"), "--window 7,8: tipin15 is from 0 to 6 s"),
    ],
)
def test_a_figure_that_cannot_be_is_refused_before_the_run(simulate, options, message):
    (code, _, err), folder = simulate(*options)
    assert (code, err) == (2, f"driveline simulate: {message}\n")
    assert not folder.exists()


def test_an_fmu_of_somebody_else_takes_its_place_under_its_own_names(simulate, tmp_path):
    car = build_car(tmp_path / "car", T_gear=("Shaft.tau", "N.m", 1.0), v=("speed", "km/h", 1 / 3.6))
    renamed = ("--map", "plant.T_gear=Shaft.tau", "--map", "plant.v=speed")
    (code, _, err), folder = simulate("--plant", str(car), *renamed)
    assert (code, err) == (0, "")
    signals = read_csv(folder / "Theirs_tipin15_DampingController.csv")
    assert signals["plant.v"][0] == pytest.approx(15 / 3.6)
    (code, _, err), _ = simulate("--plant", str(car), "--map", "plant.T_gear")
    assert code == 2
    assert "plant.T_gear=Shaft.tau" in err


def test_every_block_can_be_named(built):
    files = {place: str(built / f"{names[0]}.fmu") for place, names in PLACES.items()}
    args = given("simulate", *(word for place, file in files.items() for word in (f"--{place}", file)))
    assert resolved(args, args.plant, args.controller).settings.blocks == files


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("plant.J_1=0.0009", "plant.J_1 = 0.0009: TwoMassDriveline.fmu takes 0.001 to 10 kg.m2"),
        ("plant.J_1=10.001", "plant.J_1 = 10.001: TwoMassDriveline.fmu takes 0.001 to 10 kg.m2"),
    ],
)
def test_a_parameter_beyond_its_bounds_is_named_before_anything_runs(simulate, given, message):
    (code, _, err), folder = simulate("--set", given, "--quiet")
    assert (code, err) == (2, f"driveline simulate: {message}\n")
    assert not folder.exists()


def test_what_memory_does_not_hold_and_what_the_system_refuses_is_one_line(simulate, capsys, tmp_path):
    (code, _, err), _ = simulate("--step", "1e-15")
    assert code == 1
    assert err.startswith("driveline simulate: not enough memory")
    pipe = tmp_path / "gains.toml"
    os.mkfifo(pipe)
    message = f"driveline design: {pipe}: it is a pipe that nobody reads\n"
    assert answer(capsys, "design", "--output", str(pipe)) == (1, "", message)


@pytest.mark.parametrize(
    ("arguments", "made_by"), [([], "driveline build"), (["--build", "native"], "driveline build --build native")]
)
@pytest.mark.parametrize("command", ["simulate", "compare", "replay harness/manoeuvres/data/town_drive.csv"])
def test_missing_fmus_are_answered_with_the_command_that_makes_them(capsys, tmp_path, command, arguments, made_by):
    code, _, err = answer(capsys, *command.split(), "--fmus", str(tmp_path), *arguments)
    assert code == 2
    assert f"`{made_by} --output {tmp_path}` makes them" in err


@pytest.mark.slow
def test_compare_as_a_document_has_every_metric_of_every_run(capsys, both_built, tmp_path):
    given = ("--fmus", str(both_built), "--output", str(tmp_path), "--manoeuvre", "prbs15", "--plant", PLANTS[0])
    code, out, err = answer(capsys, "compare", *given, "--set", "controller.k_d=0", "--json")
    assert (code, err) == (0, "")
    document = json.loads(out)
    off, on = document["runs"]
    assert (off["plant"], off["manoeuvre"], off["control"], on["control"]) == (PLANTS[0], "prbs15", False, True)
    assert set(off) == {
        "plant",
        "manoeuvre",
        "control",
        "controller",
        "absent",
        *(metric.key for metric in declared(Metrics)),
    }
    assert (off["settling_time_s"], off["absent"]["settling_time_s"]) == (None, "the manoeuvre is no step")
    drawn = [f"{PLANTS[0]}_prbs15.png"]
    assert document["files"] == [str(tmp_path / name) for name in ("table.md", "metrics.csv", *drawn)]
    # without gain only what it does in the gap and with the estimated torque is left
    assert 0.0 < on["added_torque_rms_N_m"] < 20.0


def test_check_tells_findings_by_its_exit_code_in_every_form(capsys, tmp_path):
    faulty = tmp_path / "faulty.fmu"
    faulty.write_text("no archive")
    assert answer(capsys, "check", str(faulty), "nothing.fmu")[:2] == (2, ""), "one is missing: none is looked at"
    code, out, _ = answer(capsys, "check", str(faulty))
    assert code == 1
    assert "not an FMU" in out
    code, out, _ = answer(capsys, "check", "--quiet", str(faulty))
    assert (code, len(out.splitlines())) == (1, 1)
    assert out.startswith(f"{faulty}: ")
    code, out, _ = answer(capsys, "check", "--json", str(faulty))
    document = json.loads(out)
    assert (code, document["findings"], document["fmus"][0]["fmu"]) == (1, 1, str(faulty))
    code, out, _ = answer(capsys, "check", "--format", "junit", str(faulty))
    (suite,) = ElementTree.fromstring(out)
    assert (code, suite.get("name"), suite.get("failures")) == (1, str(faulty), "1")
    assert "not an FMU" in suite.findall("testcase/failure")[0].get("message", "")


def test_check_fails_for_errors_alone_unless_it_is_strict(capsys, native, tmp_path):
    """A unit need not be there; what the standard recommends counts."""

    def with_another_date(xml):
        return re.sub('(DateAndTime="[^"]*)Z"', r'\1+00:00"', xml.replace(' unit="s"', ""))

    path = tampered(native / "MotorTorqueLoop.fmu", tmp_path / "theirs.fmu", with_another_date)
    code, out, _ = answer(capsys, "check", "--quick", str(path))
    assert code == 0
    assert "has no unit" in out
    assert answer(capsys, "check", "--quick", "--strict", str(path))[0] == 1
    assert answer(capsys, "check", "--quick", "--strict", "--ignore", "date", str(path))[0] == 0
    code, _, err = answer(capsys, "check", "--ignore", "unit", str(path))
    assert code == 2
    assert "did you mean units" in err

"""Every option that a message names is one of the command that says it; `conftest.py` holds all other tests to it."""

import ast
import re
from pathlib import Path

import pytest

from driveline.harness.commands.cli import COMMANDS as EVERY
from driveline.harness.commands.cli import main, parser
from driveline.harness.commands.target import ACTIONS
from tests import ROOT
from tests.harness.commands.conftest import OPTION, options, unknown_options

NAMES = "time [s],T_driver [Nm],T_mot [Nm],v [m/s]\n"
FILES = {
    "no column": "time [s],x [Nm],y [km/h]\n0,1,1\n1,1,1\n2,1,1\n",
    "no unit": "time,T_driver,T_mot,v\n0,1,1,1\n1,1,1,1\n2,1,1,1\n",
    "another unit": NAMES.replace("Nm", "m").replace("m/s", "m") + "0,1,1,1\n1,1,1,1\n2,1,1,1\n",
    "doubled": f"T [Nm],Driver Torque [Nm],Speed [m/s],Torque [Nm],{NAMES}" + "1,1,1,1,0,1,1,1\n" * 3,
    "beyond": f"{NAMES}0,1e6,1e6,300\n1,1,1,1\n2,1,1,1\n3,1,1,1\n",
    "gap": f"{NAMES}0,1,1,1\n1,1,1,1\n2,1,1,1\n9,1,1,1\n",
    "back": f"{NAMES}0,1,1,1\n1,1,1,1\n2,1,1,1\n1.5,1,1,1\n3,1,1,1\n4,1,1,1\n",
    "word": f"{NAMES}0,x,x,x\n1,1,1,1\n2,1,1,1\n3,1,1,1\n",
    "frames": "date Mon Jan 5 10:15:30 am 2026\nbase hex  timestamps absolute\n",
}
SAMPLES = {"--column": "v=x", "--from": "1", "--to": "2", "--dbc": "x.dbc", "--set": "motor.T_max=3"}
COMMANDS = {"replay": ["replay"], "identify": ["identify"], "simulate": ["simulate", "--manoeuvre"]}


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("name", FILES)
def test_an_option_that_a_message_names_is_one_of_the_command(
    tmp_path: Path, built: Path, command: str, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "mine.csv"
    path.write_text(FILES[name], encoding="utf-8")
    typed = [*COMMANDS[command], str(path)]
    fmus = [] if command == "identify" else ["--fmus", str(built)]
    if (command, name) == ("simulate", "gap"):
        return  # a table may have long steps
    assert main([*typed, *fmus, *(["--output", str(tmp_path / "results")] if command == "simulate" else [])]) == 2
    message = capsys.readouterr().err
    assert "mine.csv" in message
    options = set(re.findall(r"(?<=\s)--[a-z]+", message))
    assert bool(options) == (command != "simulate"), message
    for option in options:
        parser().parse_args([*typed, option, SAMPLES[option]])
        if command == "replay":  # which reads as the explorer does
            parser().parse_args(["explore", str(path), option, SAMPLES[option]])


def said(path: Path) -> list[str]:
    """The texts of a module that are no docstrings."""
    tree = ast.parse(path.read_bytes())
    documented = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    return [
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documented
    ]


def test_the_options_that_a_command_names_anywhere_are_its_own_or_those_of_the_one_that_it_names() -> None:
    for command in EVERY.keys() - {"target"}:
        for text in said(ROOT / "harness" / "commands" / f"{command}.py"):
            assert not unknown_options(command, text), (command, text)


def test_an_option_that_is_named_anywhere_is_one_of_some_command() -> None:
    known = set().union(*map(options, [*EVERY, *(f"target {action}" for action in ACTIONS)]), {"--help"})
    for path in [*(ROOT / "harness").rglob("*.py"), *(ROOT / "fmus" / "building").rglob("*.py")]:
        texts = [text for text in said(path) if " " in text]  # what is a word alone is for compilers and git
        assert {option for text in texts for option in OPTION.findall(text)} <= known, path

"""Every option that a message about a recording names is one of the command that says it."""

import re
from pathlib import Path

import pytest

from driveline.harness.commands.cli import main, parser

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
COMMANDS = {
    "replay": ["replay"],
    "identify": ["identify"],
    "simulate": ["simulate", "--manoeuvre"],
}


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

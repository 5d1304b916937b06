"""Options of the command line."""

import argparse
import io
from collections.abc import Iterator
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path
from random import Random

from driveline.fmus.building.builds import build_fmus
from driveline.harness.commands.cli import COMMANDS, main, parser
from tests.fuzz.damage import ODD
from tests.fuzz.target import Attempt, Unclean, target

RUN = "simulate"
"""The command that is run; of the others the options are read."""

SHORT = ("--manoeuvre", "tipin0", "--quiet")
LONGEST = 1000
"""Characters of what is said about wrong use."""


def actions(command: str) -> list[argparse.Action]:
    top = parser()
    choices = next(a for a in top._actions if isinstance(a, argparse._SubParsersAction)).choices
    choices[command].add_command()
    return [action for action in choices[command]._actions if not isinstance(action, argparse._HelpAction)]


def value(action: argparse.Action, random: Random) -> str:
    odd = random.choice((*ODD, "plant.J_1=x", "plant.J_1=nan", "x.y=1", "plant.nothing=1", "controller.enable=0.5"))
    sound = random.choice([*action.choices] if action.choices else ["0.001", "1", "plant.J_1=0.06", "gauss-seidel"])
    return random.choice((odd, sound))


def words(action: argparse.Action, random: Random) -> list[str]:
    name = [random.choice(action.option_strings)] if action.option_strings else []
    return name if action.nargs == 0 else [*name, value(action, random)]


def code(arguments: list[str]) -> int:
    """Exit code of the command line; of the commands that are not run, that of reading the options."""
    try:
        if arguments[0] == RUN:
            return main(arguments)
        parser().parse_args(arguments)
        return 0
    except SystemExit as end:
        return int(end.code or 0)


@target(
    "odd words as options of `driveline`",
    "exit code 0, or 1 or 2 with a short sentence",
    short=40,
    long=20_000,
)
def attempts(folder: Path) -> Iterator[Attempt]:
    fmus = folder / "fmus"
    list(build_fmus((), fmus))
    of_command = {command: actions(command) for command in COMMANDS}
    fixed = [*SHORT, "--fmus", str(fmus), "--output", str(folder / "results")]

    def attempt(random: Random) -> str:
        command = random.choice((RUN, *COMMANDS))
        drawn = random.choices(of_command[command], k=random.randint(1, 4))
        arguments = [command, *(fixed if command == RUN else []), *(w for a in drawn for w in words(a, random))]
        message, out = io.StringIO(), io.StringIO()
        try:
            with chdir(folder), redirect_stderr(message), redirect_stdout(out):  # which odd words name files in
                answer = code(arguments)
        except Exception as error:
            raise Unclean(f"driveline {arguments}: {error!r}") from error
        if answer not in (0, 1, 2) or bool(answer) != bool(message.getvalue()) or len(message.getvalue()) > LONGEST:
            raise Unclean(f"driveline {arguments}: exit code {answer}, {message.getvalue()!r}")
        return f"exit code {answer}"

    yield attempt

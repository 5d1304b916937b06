"""The command line `driveline`: finds the command and answers mistakes in one sentence.

A command is a module of `harness.commands`, see `toolground.parsers`.
"""

import argparse
from collections.abc import Sequence
from typing import NoReturn

from toolground.errors import UserError
from toolground.parsers import Parser, several_commands
from toolground.program import run_arguments, run_program

PURPOSES = {
    "run": {
        "simulate": "drive one manoeuvre and write its signals and metrics",
        "compare": "drive the manoeuvres without and with damping and compare",
        "explore": "turn knobs in a browser and see what becomes of the runs",
    },
    "recordings": {
        "replay": "drive a recorded torque demand and road without and with damping",
        "record": "drive with a pseudo-random torque and record it as a real car would",
        "identify": "identify the drive train from a recorded test drive",
    },
    "car and controller": {
        "car": "say what a vehicle file makes of a car, or write a template of one",
        "design": "compute the gains of the controller for a car",
        "analyse": "margins, poles and sensitivities of the loop",
        "target": "the controller's C on its processor",
    },
    "FMUs": {
        "build": "build the FMUs",
        "check": "check FMUs for compliance",
        "map": "draft which variables of an FMU are those of the loop",
        "ssp": "write the loop for other tools (System Structure Package)",
        "bus": "write the database of the bus (DBC)",
    },
    "studies": {
        "again": "make a result again from its record, and compare every number",
        "faults": "put faults on the controller's signals and judge what it makes of them",
        "robustness": "drive cars and sensors that are drawn at random with every controller",
    },
}
"""The commands, each with what it does, by what they are for."""

COMMANDS = {name: text for commands in PURPOSES.values() for name, text in commands.items()}

DESCRIPTION = """\
Active damping of drive-train oscillations: the closed loop of FMUs, with and without damping.

For example `driveline simulate --manoeuvre tipin15`; `driveline help COMMAND` explains a command.
"""

SHELLS = ("bash", "zsh", "tcsh")


class Completion(argparse.Action):
    """Prints what makes a shell complete commands, options and names."""

    def __call__(self, parser, namespace, values, option_string=None) -> NoReturn:
        import shtab

        complete_commands(parser)
        print(shtab.complete(parser, str(values)))
        parser.exit()


COMPLETED = {"FILE": "file", "RECORDING": "file", "FOLDER": "directory"}
"""What completes an argument, by how its metavar begins."""


def complete_commands(parser: argparse.ArgumentParser) -> None:
    """Adds the arguments of all commands, and of what they can be told to do; those that are paths complete as such."""
    for action in parser._actions:
        for start, how in COMPLETED.items():
            if str(action.metavar).startswith(start):
                action.complete = how  # type: ignore[attr-defined]
        if isinstance(action, argparse._SubParsersAction):
            for subparser in action.choices.values():
                subparser.add_command()
                complete_commands(subparser)


def parser() -> Parser:
    """The parser with all commands."""
    top = several_commands("driveline", "driveline-damping", DESCRIPTION, PURPOSES, __package__ or "")
    top.add_argument(
        "--print-completion",
        action=Completion,
        choices=SHELLS,
        metavar="SHELL",
        help=f"print the completion for {', '.join(SHELLS)} and exit",
    )
    return top


def run(args: argparse.Namespace) -> int:
    """Runs the command of the arguments; returns its exit code.

    Raises:
        UserError: the user can mend what is wrong.
    """
    if getattr(args, "list", False):
        from .manoeuvres import print_manoeuvres

        print_manoeuvres(getattr(args, "json", False))
        return 0
    from ...fmus.errors import NoSuchCar

    try:
        return run_arguments(args)
    except NoSuchCar as refusal:  # which a block says that not every command needs, so not when the file was read
        from ...fmus.building.parameter_files import in_file

        path = getattr(args, "vehicle", None)
        raise UserError(str(in_file(refusal, path) if path else refusal)) from refusal


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs `driveline`; returns its exit code, see `run_program`.

    Args:
        arguments: without the name of the program; None for those of the process.
    """
    return run_program("driveline", parser, arguments, run)

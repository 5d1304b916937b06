"""The command line `driveline`: finds the command and answers mistakes in one sentence.

A command is a module of `harness.commands` with DESCRIPTION, EXAMPLES, add_arguments(parser) and run(args) -> int. It
is imported only when it is asked for, and itself imports what it needs when it runs, so that help and mistakes are
answered at once.
"""

import argparse
import sys
from collections.abc import Sequence
from errno import ENOSPC
from importlib import import_module
from io import TextIOWrapper
from types import ModuleType
from typing import NoReturn

from ..base.errors import DrivelineError
from ..base.interruption import forget_stdout, reopen_closed_streams, stoppable
from ..base.known_names import nearest
from ..base.plain_text import plain, reason
from ..base.progress import hidden
from ..base.status_line import waiting

COMMANDS = {
    "build": "build the FMUs",
    "simulate": "drive the loop through one manoeuvre and write its signals",
    "compare": "run the manoeuvres without and with damping and compare",
    "replay": "drive a recorded torque demand and road without and with damping",
    "record": "drive with a pseudo-random torque and record it as a real car would",
    "identify": "identify the drive train from a recorded test drive",
    "faults": "put faults on the controller's signals and judge what it makes of them",
    "robustness": "drive random cars and sensors with every controller",
    "explore": "turn knobs in a browser and see what becomes of the runs",
    "check": "check FMUs for compliance",
    "design": "compute the gains of the controller",
    "analyse": "margins, poles and sensitivities of the loop",
    "ssp": "write the loop for other tools (System Structure Package)",
    "target": "the controller's C on its processor",
    "bus": "write the database of the bus (DBC)",
    "bound": "compute what no controller can beat, beside what ours reaches",
    "coupling": "measure coupling error and dead time of the master",
    "back-to-back": "compare both builds of each block with its functions",
}

DESCRIPTION = """\
Active damping of drive-train oscillations: the closed loop of FMUs, with and without damping.

First `driveline build`, then for example `driveline simulate --manoeuvre tipin15`;
`driveline COMMAND --help` explains a command.
"""

EXIT_CODES = (
    "exit codes: 0 done, 1 something went wrong or there are findings, 2 wrong use, 128 + n stopped by signal n"
)

SHELLS = ("bash", "zsh", "tcsh")


def command(name: str) -> ModuleType:
    """The module of a command."""
    return import_module(f".{name.replace('-', '_')}", __package__)


class Parser(argparse.ArgumentParser):
    """Takes the arguments of a command from its module, and answers unknown options and values with the nearest.

    Attributes:
        command: name of the command whose arguments are still to be added; None for all others.
    """

    command: str | None = None

    def add_command(self) -> None:
        """Adds description, examples and arguments of the command."""
        if self.command is None:
            return
        module, self.command = command(self.command), None
        self.description, self.epilog = module.DESCRIPTION, module.EXAMPLES
        module.add_arguments(self)

    def parse_known_args(self, args=None, namespace=None):  # type: ignore[override]
        self.add_command()
        known, unknown = super().parse_known_args(args, namespace)
        options = [word.partition("=")[0] for word in unknown if word.startswith("--")]
        if options:
            self.error(f"unknown option {plain(options[0], 60)}; {nearest(options[0], self._option_string_actions)}")
        return known, unknown

    def _check_value(self, action: argparse.Action, value: str) -> None:
        if action.choices is not None and value not in action.choices:
            name = "/".join(action.option_strings) or str(action.metavar).lower()
            self.error(f"{name}: {plain(value, 60) or 'an empty name'} is unknown; {nearest(value, action.choices)}")

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n(`{self.prog} --help` explains)\n")


class Version(argparse.Action):
    """Prints the version of the package."""

    def __call__(self, parser, namespace, values, option_string=None) -> NoReturn:
        from importlib.metadata import version

        print(f"driveline-damping {version('driveline-damping')}")
        parser.exit()


class Completion(argparse.Action):
    """Prints what makes a shell complete commands, options and names."""

    def __call__(self, parser, namespace, values, option_string=None) -> NoReturn:
        import shtab

        complete_commands(parser)
        print(shtab.complete(parser, str(values)))
        parser.exit()


def complete_commands(parser: argparse.ArgumentParser) -> None:
    """Adds the arguments of all commands, and of what they can be told to do."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for subparser in action.choices.values():
                subparser.add_command()
                complete_commands(subparser)


def parser() -> Parser:
    """The parser with all commands."""
    style = argparse.RawDescriptionHelpFormatter
    top = Parser(prog="driveline", description=DESCRIPTION, epilog=EXIT_CODES, formatter_class=style)
    top.add_argument("--version", action=Version, nargs=0, help="print the version and exit")
    top.add_argument(
        "--print-completion",
        action=Completion,
        choices=SHELLS,
        metavar="SHELL",
        help=f"print the completion for {', '.join(SHELLS)} and exit",
    )
    subparsers = top.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, text in COMMANDS.items():
        subparsers.add_parser(name, help=text, formatter_class=style).command = name
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs `driveline`; returns its exit code, see EXIT_CODES; 130 stopped at the keyboard, 128 + n by signal n.

    Args:
        arguments: without the name of the program; None for those of the process.
    """
    name = "driveline"
    reopen_closed_streams()
    if isinstance(sys.stdout, TextIOWrapper):
        sys.stdout.reconfigure(line_buffering=True)  # who reads a pipe need not wait for the end either
    try:
        with stoppable():
            try:
                args = parser().parse_args(arguments)
                name = f"driveline {args.command}"
                silent = getattr(args, "quiet", False) or getattr(args, "json", False)
                with hidden(silent), waiting(name, enabled=not silent):
                    return command(args.command).run(args)
            finally:
                sys.stdout.flush()
    except BrokenPipeError as gone:
        forget_stdout()  # the reader has gone
        return int(gone.__context__.code or 0) if isinstance(gone.__context__, SystemExit) else 1
    except DrivelineError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return error.exit_code
    except OSError as error:
        if error.errno == ENOSPC and error.filename is None:  # whoever writes files names them
            error.filename = "standard output"
            forget_stdout()
        print(f"{name}: {reason(error)}", file=sys.stderr)
        return 1
    except MemoryError as error:
        print(f"{name}: not enough memory: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt as stop:
        print("; ".join([f"{name}: stopped", *getattr(stop, "__notes__", [])]), file=sys.stderr)
        return getattr(stop, "exit_code", 130)

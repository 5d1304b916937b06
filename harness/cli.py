"""The command line `driveline`: collects the subcommands and answers mistakes in one sentence."""

import argparse
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from .commands import back_to_back, build, check, compare, coupling, design, replay, simulate
from .errors import DrivelineError
from .names import nearest

_MODULES = (build, simulate, compare, replay, check, design, coupling, back_to_back)

COMMANDS = {command.NAME: command for command in _MODULES}

DESCRIPTION = """\
Active damping of drive-train oscillations: the closed loop of FMUs, with and without control.

First `driveline build`, then for example `driveline simulate --manoeuvre tipin15`;
`driveline COMMAND --help` explains a command.
"""


class Parser(argparse.ArgumentParser):
    """Answers an unknown option with the nearest known ones."""

    def parse_known_args(self, args=None, namespace=None):  # type: ignore[override]
        known, unknown = super().parse_known_args(args, namespace)
        options = [word.partition("=")[0] for word in unknown if word.startswith("--")]
        if options:
            self.error(f"unknown option {options[0]}; {nearest(options[0], self._option_string_actions)}")
        return known, unknown

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n(`{self.prog} --help` explains)\n")


def parser() -> argparse.ArgumentParser:
    """The parser with all subcommands."""
    top = Parser(prog="driveline", description=DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter)
    subparsers = top.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, command in COMMANDS.items():
        subparser = subparsers.add_parser(
            name,
            help=command.HELP,
            description=command.DESCRIPTION,
            epilog=command.EXAMPLES,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        command.add_arguments(subparser)
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs `driveline`; returns its exit code: 0 done, 1 failed or findings, 2 wrong use.

    Args:
        arguments: without the name of the program; None for those of the process.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    top = parser()
    if words and not words[0].startswith("-") and words[0] not in COMMANDS:
        top.error(f"unknown command {words[0]}; {nearest(words[0], COMMANDS)}")
    args = top.parse_args(words)
    try:
        return COMMANDS[args.command].run(args)
    except BrokenPipeError:
        # the reader has gone; nothing may be flushed to it at exit either
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except DrivelineError as error:
        print(f"driveline {args.command}: {error}", file=sys.stderr)
        return error.exit_code
    except OSError as error:
        print(f"driveline {args.command}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f"driveline {args.command}: stopped", file=sys.stderr)
        return 130

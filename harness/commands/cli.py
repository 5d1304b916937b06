"""The command line `driveline`: finds the command and answers mistakes in one sentence.

A command is a module of `harness.commands` with the record `Arguments` (see `arguments`) and `run(args: Arguments)`,
which returns the exit code, or with ACTIONS that are such pairs. Its docstring is its help, to which its IN_HELP may
give what stands there in braces; `--help` shows the first paragraph, the options that most need and the examples. It
is imported only when it is asked for, and itself imports what it needs when it runs, so that help and mistakes are
answered at once.
"""

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from errno import ENOSPC
from functools import partial
from importlib import import_module
from io import TextIOWrapper
from typing import Any, NamedTuple, NoReturn
from unicodedata import category

from toolground import command_line
from toolground.errors import UserError
from toolground.interruption import STDOUT, forget_stdout, named_stdout, reopen_closed_streams, stoppable, unswallowed
from toolground.known_names import nearest
from toolground.plain_text import plain, quoted, reason
from toolground.progress import hidden
from toolground.status_line import waiting

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

EXIT_CODES = (
    "exit codes: 0 done, 1 something went wrong or there are findings, 2 wrong use, 128 + n stopped by signal n"
)

SHELLS = ("bash", "zsh", "tcsh")


Style = partial(argparse.RawDescriptionHelpFormatter, max_help_position=32)


class Command(NamedTuple):
    """What a parser parses for.

    Attributes:
        record: of its arguments.
        run: takes the record, returns the exit code.
    """

    record: type
    run: Callable[[Any], int]


class HelpAll(argparse.Action):
    """Prints all of the help of a command."""

    def __call__(self, parser, namespace, values, option_string=None) -> NoReturn:
        parser._print_message(parser.format_help(everything=True), sys.stdout)  # type: ignore[call-arg]  # see Parser
        parser.exit()


class Parser(argparse.ArgumentParser):
    """Takes the arguments of a command from its module, and answers unknown options and values with the nearest.

    Attributes:
        command: name of the command whose arguments are still to be added, or the command; None for all others.
    """

    command: str | Command | None = None

    def add_command(self) -> None:
        """Adds description, examples and arguments of the command."""
        if self.command is None:
            return
        found, self.command = self.command, None
        if isinstance(found, str):
            module = import_module(f".{found}", __package__)
            self._describe((module.__doc__ or "").format(**getattr(module, "IN_HELP", {})))
            if hasattr(module, "ACTIONS"):
                actions = {name: (Command(*both), text) for name, (*both, text) in module.ACTIONS.items()}
                self.add_commands(actions, "action")
                return
            found = Command(module.Arguments, module.run)
        else:
            from inspect import cleandoc

            self._describe(cleandoc(found.record.__doc__ or ""))
        from .arguments import EXPERTS, add_arguments  # what the help of `driveline` does without

        self.add_argument("--help-all", action=HelpAll, nargs=0, help="tell more, with the options for experts")
        add_arguments(self, found.record)
        self.set_defaults(found=found, program=self.prog)
        self.usage = self.short_usage()
        self._action_groups.sort(key=lambda group: group.title == EXPERTS)

    def _describe(self, text: str) -> None:
        self.description, *examples = text.partition("examples:\n")
        self.epilog = "".join(examples)

    def format_help(self, everything: bool = False) -> str:
        """The help, by default without what few need: the first paragraph alone, and no options for experts."""
        from .arguments import EXPERTS

        formatter, text = self._get_formatter(), self.description or ""
        formatter.add_usage(self.usage, self._actions, self._mutually_exclusive_groups)
        formatter.add_text(text if everything else text.partition("\n\n")[0])
        for group in self._action_groups:
            if everything or group.title != EXPERTS:
                formatter.start_section(group.title)
                formatter.add_arguments(group._group_actions)
                formatter.end_section()
        formatter.add_text(self.epilog)
        return formatter.format_help()

    def add_commands(self, commands: Mapping[str, tuple[str | Command, str]], dest: str) -> None:
        """Adds commands by their names, each with what it does; `dest` gets the one that is given."""
        subparsers = self.add_subparsers(
            dest=dest, metavar=dest.upper(), required=True, prog=self.prog, parser_class=Parser
        )
        for name, (found, text) in commands.items():
            subparsers.add_parser(name, help=text, formatter_class=Style).command = found

    def short_usage(self) -> str:
        """How the command is called, without its options one by one."""
        formatter = self._get_formatter()
        formatter.add_usage(None, self._get_positional_actions(), [], prefix="")
        return formatter.format_help().strip().replace(self.prog, f"{self.prog} [OPTION ...]", 1)

    def parse_known_args(self, args=None, namespace=None):  # type: ignore[override]
        self.add_command()
        self._values: dict[argparse.Action, tuple[object, str]] = {}
        known, unknown = super().parse_known_args(args, namespace)
        options = [word.partition("=")[0] for word in unknown if word.startswith("--")]
        if options:
            self.error(f"unknown option {plain(options[0], 60)}; {nearest(options[0], self._option_string_actions)}")
        return known, unknown

    def _get_values(self, action: argparse.Action, arg_strings: list[str]) -> Any:
        """As argparse does, which of an option with one value takes the last, whatever was given before."""
        value, words = super()._get_values(action, arg_strings), " ".join(arg_strings)
        if isinstance(action, argparse._StoreAction) and action.option_strings:
            first, before = self._values.setdefault(action, (value, words))
            if first != value:
                both = f"{quoted(before)} and {quoted(words)}"
                self.error(f"{action.option_strings[0]} is given twice, {both}; it takes one value")
        return value

    def _check_value(self, action: argparse.Action, value: str) -> None:
        if action.choices is not None and value not in action.choices:
            name = "/".join(action.option_strings) or str(action.metavar).lower()
            self.error(f"{name}: {plain(value, 60) or 'an empty name'} is unknown; {nearest(value, action.choices)}")

    def _print_message(self, message: str, file: Any = None) -> None:
        """As argparse does, which takes no notice of a disk that is full."""
        if message:
            with suppress(BrokenPipeError):  # noticed when the rest is written
                (file or sys.stderr).write(message)

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n(`{self.prog} --help` explains)\n")


class Top(Parser):
    """The parser of `driveline` itself, whose help has the commands by what they are for."""

    def format_help(self, everything: bool = False) -> str:
        formatter = self._get_formatter()
        formatter.add_usage(self.usage, self._actions, self._mutually_exclusive_groups)
        formatter.add_text(self.description)
        (commands,) = (action for action in self._actions if isinstance(action, argparse._SubParsersAction))
        named = {action.dest: action for action in commands._get_subactions()}
        options = [action for action in self._actions if action is not commands]
        sections = {purpose: [named[name] for name in names] for purpose, names in PURPOSES.items()}
        for title, actions in {**sections, "options": options}.items():
            formatter.start_section(title)
            formatter.add_arguments(actions)
            formatter.end_section()
        formatter.add_text(self.epilog)
        return formatter.format_help()


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
    top = Top(
        prog="driveline",
        description=DESCRIPTION,
        epilog=EXIT_CODES,
        formatter_class=partial(Style, max_help_position=16),
    )
    top.add_argument("--version", action=Version, nargs=0, help="print the version and exit")
    top.add_argument(
        "--print-completion",
        action=Completion,
        choices=SHELLS,
        metavar="SHELL",
        help=f"print the completion for {', '.join(SHELLS)} and exit",
    )
    top.add_commands({name: (name, text) for name, text in COMMANDS.items()}, "command")
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
    from fmublocks.errors import BuildError

    from ...fmus.errors import NoSuchCar
    from .arguments import filled

    try:
        return args.found.run(filled(args.found.record, args))
    except NoSuchCar as refusal:  # which a block says that not every command needs, so not when the file was read
        from ...fmus.building.parameter_files import in_file

        path = getattr(args, "vehicle", None)
        raise UserError(str(in_file(refusal, path) if path else refusal)) from refusal
    except BuildError as refusal:
        raise UserError(str(refusal)) from refusal


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs `driveline`; returns its exit code, see EXIT_CODES; 130 stopped at the keyboard, 128 + n by signal n.

    Args:
        arguments: without the name of the program; None for those of the process.
    """
    name, words = "driveline", list(sys.argv[1:] if arguments is None else arguments)
    if words[:1] == ["help"]:
        words = [*words[1:], "--help"]
    command_line.words.set(["driveline", *words])
    reopen_closed_streams()
    if isinstance(sys.stdout, TextIOWrapper):
        # who reads a pipe need not wait for the end either, and not every terminal has a middle dot
        sys.stdout.reconfigure(line_buffering=True, errors="replace")
    try:
        with stoppable(), unswallowed(), named_stdout():
            try:
                _require_printable(words)
                args = parser().parse_args(words)
                name = args.program
                silent = getattr(args, "quiet", False) or getattr(args, "json", False)
                with hidden(silent), waiting(name, enabled=not silent):
                    return run(args)
            finally:
                sys.stdout.flush()
    except BrokenPipeError as gone:
        forget_stdout()  # the reader has gone
        return int(gone.__context__.code or 0) if isinstance(gone.__context__, SystemExit) else 1
    except UserError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return error.exit_code
    except OSError as error:
        if error.filename == STDOUT:
            forget_stdout()
        elif error.errno == ENOSPC and error.filename is None:  # whoever writes results names them
            from toolground.errors import full_disk

            error = full_disk()
        print(f"{name}: {reason(error)}", file=sys.stderr)
        return 1
    except MemoryError as error:
        print(f"{name}: not enough memory: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt as stop:
        print("; ".join([f"{name}: stopped", *getattr(stop, "__notes__", [])]), file=sys.stderr)
        return getattr(stop, "exit_code", 130)


UNPRINTABLE = {"Cc": "control characters", "Zl": "line ends", "Zp": "line ends", "Cs": "bytes that are no text"}
"""Categories of Unicode that no argument may have, but for the tabulator."""


def _require_printable(words: Sequence[str]) -> None:
    """
    Raises:
        UserError: a word, as the path of a file, would be no plain line in the messages, tables and names of files
            that repeat it.
    """
    for word in words:
        if found := next((UNPRINTABLE[c] for c in map(category, word.replace("\t", "")) if c in UNPRINTABLE), None):
            raise UserError(f"the argument {word[:60]!r} has {found}; rename the file")

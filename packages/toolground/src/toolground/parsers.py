"""Parsers of programs and their commands: mistakes are answered in one sentence, help teaches with examples.

A command is a module with the record `Arguments` (see `arguments`) and `run(args: Arguments)`, which returns the exit
code, or with ACTIONS that are such pairs. Its docstring is its help, to which its IN_HELP may give what stands there in
braces; `--help` shows the first paragraph, the options that most need and the examples. It is imported only when it is
asked for, and itself imports what it needs when it runs, so that help and mistakes are answered at once.
"""

import argparse
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from importlib import import_module
from typing import Any, NamedTuple, NoReturn

from .known_names import nearest
from .plain_text import plain, quoted

EXIT_CODES = (
    "exit codes: 0 done, 1 something went wrong or there are findings, 2 wrong use, 128 + n stopped by signal n"
)

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
        command: name of the module of the command whose arguments are still to be added, or the command; None for all
            others.
    """

    command: str | Command | None = None

    def add_command(self) -> None:
        """Adds description, examples and arguments of the command."""
        if self.command is None:
            return
        found, self.command = self.command, None
        if isinstance(found, str):
            module = import_module(found)
            self._describe((module.__doc__ or "").format(**getattr(module, "IN_HELP", {})))
            if hasattr(module, "ACTIONS"):
                actions = {name: (Command(*both), text) for name, (*both, text) in module.ACTIONS.items()}
                self.add_commands(actions, "action")
                return
            found = Command(module.Arguments, module.run)
        else:
            from inspect import cleandoc

            self._describe(cleandoc(found.record.__doc__ or ""))
        from .arguments import EXPERTS, add_arguments  # what the help of a program does without

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
    """The parser of a program with several commands, whose help has them by what they are for.

    Attributes:
        purposes: what they are for, and of each command what it does.
    """

    purposes: Mapping[str, Mapping[str, str]]

    def format_help(self, everything: bool = False) -> str:
        formatter = self._get_formatter()
        formatter.add_usage(self.usage, self._actions, self._mutually_exclusive_groups)
        formatter.add_text(self.description)
        (commands,) = (action for action in self._actions if isinstance(action, argparse._SubParsersAction))
        named = {action.dest: action for action in commands._get_subactions()}
        options = [action for action in self._actions if action is not commands]
        sections = {purpose: [named[name] for name in names] for purpose, names in self.purposes.items()}
        for title, actions in {**sections, "options": options}.items():
            formatter.start_section(title)
            formatter.add_arguments(actions)
            formatter.end_section()
        formatter.add_text(self.epilog)
        return formatter.format_help()


class Version(argparse.Action):
    """Prints the version of a distribution, its `const`."""

    def __call__(self, parser, namespace, values, option_string=None) -> NoReturn:
        from importlib.metadata import version

        print(f"{self.const} {version(str(self.const))}")
        parser.exit()


def several_commands(
    name: str, distribution: str, description: str, purposes: Mapping[str, Mapping[str, str]], package: str
) -> Top:
    """The parser of a program with several commands.

    Args:
        distribution: whose version is that of the program.
        purposes: of its commands, and of each what it does.
        package: of the modules of the commands, which have their names.
    """
    top = Top(
        prog=name, description=description, epilog=EXIT_CODES, formatter_class=partial(Style, max_help_position=16)
    )
    top.purposes = purposes
    _add_version(top, distribution)
    commands = {name: text for names in purposes.values() for name, text in names.items()}
    top.add_commands({name: (f"{package}.{name}", text) for name, text in commands.items()}, "command")
    return top


def single_command(name: str, distribution: str, module: str) -> Parser:
    """The parser of a program that is one command."""
    parser = Parser(prog=name, formatter_class=Style)
    _add_version(parser, distribution)
    parser.command = module
    return parser


def _add_version(parser: Parser, distribution: str) -> None:
    parser.add_argument("--version", action=Version, nargs=0, const=distribution, help="print the version and exit")

"""A page for each command of `driveline`, from its parser."""

import argparse
import html
import re
from collections.abc import Iterator, Mapping

from docs.site import ROOT
from driveline.harness.commands.cli import COMMANDS, PURPOSES, complete_commands, parser
from toolground.parsers import EXIT_CODES

FOLDER = "commands"

WIDTH = 84
"""Of usage in characters: what a page shows beside its navigation."""

ENTRY = re.compile(r"^ {1,4}(\S.*?) {2,}(\S.*(?:\n {5,}\S.*)*)", re.M)
"""A name and what it means, in two columns."""


def pages() -> Mapping[str, str]:
    """The pages, by their path in the site."""
    top = parser()
    complete_commands(top)
    (commands,) = _subparsers(top)
    return {f"{FOLDER}/index.md": _index(top)} | {
        f"{FOLDER}/{name}.md": "\n\n".join(_sections(commands[name], 1)) + "\n" for name in COMMANDS
    }


def _index(top: argparse.ArgumentParser) -> str:
    lines = ["# The command line"]
    for purpose, commands in PURPOSES.items():
        lines += ["", f"## {purpose[0].upper()}{purpose[1:]}", "", "| command | what it does |", "|---|---|"]
        lines += [f"| [`driveline {name}`]({name}.md) | {text} |" for name, text in commands.items()]
    return "\n".join([*lines, "", *_options(top), "", f"{EXIT_CODES[0].upper()}{EXIT_CODES[1:]}.", ""])


def _sections(command: argparse.ArgumentParser, level: int) -> Iterator[str]:
    """Usage, description, arguments and examples of a command, and of what it can be told to do."""
    yield f"{'#' * level} {command.prog}"
    yield from _paragraphs(command.description or "")
    yield f"```text\n{_usage(command)}\n```"
    yield "\n".join(_options(command))
    if command.epilog:
        yield f"{'#' * (level + 1)} Examples" + (f" of {command.prog}" if level > 1 else "")
        yield _examples(command.epilog)
    for below in _subparsers(command):
        for each in below.values():
            yield from _sections(each, level + 1)


def _subparsers(command: argparse.ArgumentParser) -> Iterator[Mapping[str, argparse.ArgumentParser]]:
    for action in command._actions:
        if isinstance(action, argparse._SubParsersAction):
            yield action.choices


def _usage(command: argparse.ArgumentParser) -> str:
    formatter = argparse.HelpFormatter(command.prog, width=WIDTH)
    formatter.add_usage(command.usage, command._actions, command._mutually_exclusive_groups, prefix="")
    return formatter.format_help().strip()


def _paragraphs(text: str) -> Iterator[str]:
    """What a terminal shows, as Markdown: two columns become a list, other indented lines keep their shape."""
    for paragraph in re.split(r"\n\s*\n", text.strip("\n")):
        if not ENTRY.sub("", paragraph).strip():
            yield "\n".join(
                f"- **{name}**: {_prose(' '.join(said.split()))}" for name, said in ENTRY.findall(paragraph)
            )
        elif any(line.startswith(" ") for line in paragraph.splitlines()):
            yield f"```text\n{paragraph}\n```"
        else:
            yield _prose(paragraph)


def _prose(text: str) -> str:
    """Names of pages become links."""
    return re.sub(r"\bdocs/(\w+\.md)", r"[docs/\1](../\1)", html.escape(text, quote=False).replace("*", r"\*"))


def _examples(epilog: str) -> str:
    lines = epilog.removeprefix("examples:\n").rstrip().splitlines()
    return "\n".join(["```sh", *(line.removeprefix("  ") for line in lines), "```"])


def _options(command: argparse.ArgumentParser) -> Iterator[str]:
    """A list of definitions; of commands below a command the page shows more."""
    formatter = argparse.HelpFormatter(command.prog)
    for action in command._actions:
        if isinstance(action, argparse._HelpAction | argparse._SubParsersAction):
            continue
        text = formatter._expand_help(action) if action.help else ""
        yield f"`{formatter._format_action_invocation(action)}`\n:   {_prose(text.replace(f'{ROOT}/', ''))}\n"

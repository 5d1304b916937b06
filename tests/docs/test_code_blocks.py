"""What pages show can be typed: commands have these options, Python names what is there."""

import argparse
import ast
import re
import tomllib
from collections.abc import Iterator
from importlib.util import find_spec
from itertools import chain
from pathlib import Path

import pytest
import yaml

import driveline
from driveline.harness.commands.cli import COMMANDS, complete_commands, parser
from tests import ROOT
from tests.docs.pages import INLINE, PAGES, blocks, commands, named, prose, text_of

PUBLIC = frozenset(dir(driveline))

INSIDE = ("driveline.", "harness", "fmus", "models")
"""What modules begin with that a user does not import."""

EVERY_PAGE = pytest.mark.parametrize("page", PAGES, ids=named)


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder with the examples, and with the files that pages speak of."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    return tmp_path


@EVERY_PAGE
def test_commands_are_understood(page: Path, checkout: Path) -> None:
    for script in blocks(page, "sh"):
        for arguments in commands(script):
            if "--print-completion" not in arguments:
                parser().parse_args(arguments)


WRITING = ("replace", "plot", "figures", "window", "report", "json", "quiet", "frames", "look", "fmus")
"""Options that do not make a run another one."""

PARTS = {
    "simulate": ("plant", "manoeuvre", "control"),
    "record": ("plant", "control"),
    "replay": ("recording",),
    "faults": ("case",),
    "robustness": ("case",),
}
"""What the names of the files of a run have in them; others have one name for all."""

DEMO = "\n".join(re.findall(r"driveline (?:compare|replay) .*", (ROOT / "Makefile").read_text(encoding="utf-8")))


def test_a_command_finds_no_other_run_where_it_writes(checkout: Path) -> None:
    """All that pages show, typed one after the other in a checkout in which `make demo` was made."""
    there: dict[tuple[str, ...], tuple[str, dict[str, str]]] = {}
    others = []
    for page in (ROOT / "Makefile", ROOT / "README.md", *(page for page in PAGES if "\nMade by " not in text_of(page))):
        for words in commands(DEMO) if page.name == "Makefile" else chain(*map(commands, blocks(page, "sh"))):
            args = vars(parser().parse_args(words)) if "--print-completion" not in words else {}
            if args.get("output") and "replace" in args and not args.get("look"):
                run = {name: str(value) for name, value in args.items() if name not in WRITING}
                place = (args["program"], str(args["output"]), *(run[part] for part in PARTS.get(words[0], ())))
                _, before = there.setdefault(place, (page.name, run))
                if before != run and not args["replace"]:
                    others.append(f"{named(page)}: {' '.join(words)}; as of {there[place][0]}")
                there[place] = page.name, run
    assert not others, "\n".join(others)


@EVERY_PAGE
def test_commands_in_a_sentence_exist_with_their_options(page: Path) -> None:
    top = parser()
    complete_commands(top)
    known = {name: set(options(top, name)) for name in COMMANDS}
    for code in INLINE.findall(prose(page)):
        words = code.split()
        if words[0] == "driveline" and len(words) > 1 and words[1].islower() and words[1].isalpha():
            assert words[1] in COMMANDS, code
            given = {word.partition("=")[0] for word in words if word.startswith("--")}
            assert given <= known[words[1]], code


def options(command: argparse.ArgumentParser, *path: str) -> Iterator[str]:
    """Of what a path of commands leads to, and of all below."""
    if not path:
        yield from command._option_string_actions
    for action in command._actions:
        if isinstance(action, argparse._SubParsersAction):
            for name in path[:1] or action.choices:
                yield from options(action.choices[name], *path[1:])


@EVERY_PAGE
def test_python_can_be_read_and_imports_what_is_there(page: Path) -> None:
    for code in blocks(page, "python"):
        for node in ast.walk(ast.parse(code)):
            if isinstance(node, ast.ImportFrom) and node.module == "driveline":
                assert {alias.name for alias in node.names} <= PUBLIC
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "driveline":
                assert node.attr in PUBLIC


@EVERY_PAGE
def test_what_is_not_public_is_not_shown(page: Path) -> None:
    for code in blocks(page, "python"):
        for node in ast.walk(ast.parse(code)):
            if isinstance(node, ast.Import):
                assert not [each.name for each in node.names if each.name.startswith(INSIDE)]
            if isinstance(node, ast.ImportFrom):
                assert not (node.module or "").startswith(INSIDE)
    assert not re.findall(r"driveline\.(?:harness|models|fmus)\b", text_of(page))


@EVERY_PAGE
def test_names_in_a_sentence_are_public(page: Path) -> None:
    for code in INLINE.findall(prose(page)):
        if name := re.match(r"driveline\.([A-Za-z]\w*)", code):
            assert name[1] in PUBLIC, code


@EVERY_PAGE
def test_files_that_are_shown_can_be_read(page: Path) -> None:
    for code in blocks(page, "toml"):
        tomllib.loads(code)
    for code in blocks(page, "yaml"):
        assert yaml.safe_load(code)


def test_modules_that_pages_run_are_there() -> None:
    for page in PAGES:
        for module in re.findall(r"python -m ([\w.]+)", page.read_text(encoding="utf-8")):
            assert find_spec(module), module

"""What pages show can be typed: options exist, Python names what is there, and both print what they show."""

import argparse
import ast
import re
import shlex
import tomllib
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest
import yaml
from fmutesting.together import together

import driveline
from driveline.harness.commands.cli import COMMANDS, complete_commands, main, parser
from tests import ROOT
from tests.docs.pages import BLOCK, INLINE, PAGES, blocks, commands, prose, text_of

PUBLIC = frozenset(dir(driveline))

INSIDE = re.compile(r"(driveline\.|harness|fmus|models)")
"""What modules begin with that a user does not import."""

README, TUTORIAL = ROOT / "README.md", ROOT / "docs" / "tutorial.md"
TROUBLESHOOTING = ROOT / "docs" / "troubleshooting.md"


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder with the examples."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    return tmp_path


@together("page", PAGES)
def test_what_a_page_shows_can_be_typed(page: Path, checkout: Path) -> None:
    for script in blocks(page, "sh"):
        for arguments in commands(script):
            parser().parse_args(arguments)
    for code in blocks(page, "toml"):
        tomllib.loads(code)
    for code in blocks(page, "yaml"):
        assert yaml.safe_load(code)
    wrong = [name for name in re.findall(r"python -m ([\w.]+)", text_of(page)) if not find_spec(name)]
    wrong += [name for name in names_in_python(page) if name not in PUBLIC]
    wrong += [code for code in INLINE.findall(prose(page)) if not is_known(code)]
    wrong += re.findall(r"driveline\.(?:harness|models|fmus)\b", text_of(page))
    assert wrong == []


def names_in_python(page: Path) -> Iterator[str]:
    """Of `driveline` in its blocks of Python, and of whatever else of ours is imported there."""
    for code in blocks(page, "python"):
        for node in ast.walk(ast.parse(code)):
            match node:
                case ast.Attribute(value=ast.Name(id="driveline"), attr=name):
                    yield name
                case ast.ImportFrom(module="driveline", names=names):
                    yield from (alias.name for alias in names)
                case ast.ImportFrom(module=str(module)) if INSIDE.match(module):
                    yield module
                case ast.Import(names=names):
                    yield from (alias.name for alias in names if INSIDE.match(alias.name))


def is_known(code: str) -> bool:
    """Whether a command in a sentence has the options that stand with it there, and a name of `driveline` is public."""
    if name := re.match(r"driveline\.([A-Za-z]\w*)", code):
        return name[1] in PUBLIC
    words = code.split()
    if words[0] != "driveline" or len(words) < 2 or not re.fullmatch("[a-z]+", words[1]):
        return True
    given = {word.partition("=")[0] for word in words if word.startswith("--")}
    return words[1] in COMMANDS and given <= set(options(whole_parser(), words[1]))


def whole_parser() -> argparse.ArgumentParser:
    top = parser()
    complete_commands(top)
    return top


def options(command: argparse.ArgumentParser, *path: str) -> Iterator[str]:
    """Of what a path of commands leads to, and of all below."""
    if not path:
        yield from command._option_string_actions
    for action in command._actions:
        if isinstance(action, argparse._SubParsersAction):
            for name in path[:1] or action.choices:
                yield from options(action.choices[name], *path[1:])


@pytest.mark.slow
def test_the_commands_of_the_tutorial_run(both_built: Path, checkout: Path) -> None:
    for arguments in (words for script in blocks(TUTORIAL, "sh") for words in commands(script)):
        fmus = ["--fmus", str(both_built)] if arguments[0] in ("simulate", "compare") else []
        assert arguments[0] == "build" or main([*arguments, *fmus]) == 0, shlex.join(arguments)


def test_the_lines_of_python_of_readme_and_tutorial_print_what_they_show(both_built, capsys) -> None:
    def printed(code: str) -> str:
        exec(code.replace("simulate(tipin, ", f"simulate(tipin, folder=Path({str(both_built)!r}), "), {"Path": Path})
        return capsys.readouterr().out

    (example,) = blocks(README, "python")
    assert 0.05 < float(printed(example)) < 0.2
    (_, code), (_, shown) = [
        (kind, code) for kind, code in BLOCK.findall(text_of(TUTORIAL)) if kind in ("python", "text")
    ]
    assert printed(code) == shown


FILES = {
    "car.toml": "J_1 = 0.05\nmass = 1500\n",
    "contradictory.toml": "C = 220.0\nk_s = 25800.0\n",
    "torque_alone.csv": "time [s],T_ref [N.m]\n0,10\n0.01,12\n",
    "no_unit.csv": "time [s],T_mot [N.m],speed\n0,10,20\n0.01,12,20\n0.02,12,20\n",
    "not_in_order.csv": "time [s],T_mot [N.m],v [km/h]\n0,10,20\n0.02,12,20\n0.01,12,20\n",
    "gap.csv": "time [s],T_mot [N.m],v [km/h]\n0,10,20\n0.01,12,20\n0.02,12,20\n5,12,20\n",
    "not_a_number.csv": "time [s],T_mot [N.m],v [km/h]\n0,10,20\n0.01,x,20\n0.02,12,20\n",
}
"""What the commands of the page on messages are given."""


def test_commands_say_what_the_page_on_messages_shows(built, read_here, checkout, monkeypatch, capsys) -> None:
    for name, content in FILES.items():
        (checkout / name).write_text(content, encoding="utf-8")
    monkeypatch.setenv("COLUMNS", "80")
    shown = list(blocks(TROUBLESHOOTING, "console"))
    for line, _, message in (block.partition("\n") for block in shown):
        arguments = shlex.split(line)[2:]
        where = [] if "--fmus" in arguments or arguments[0] not in ("simulate", "replay") else ["--fmus", str(built)]
        assert (answer([*arguments, *where]), capsys.readouterr().err) == (2, message)
    assert len(shown) >= 10


def answer(arguments: list[str]) -> int | str | None:
    try:
        return main(arguments)
    except SystemExit as end:
        return end.code

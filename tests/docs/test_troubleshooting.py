"""The messages that the page explains are those of the code."""

import ast
import re
import shlex
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from driveline.harness.commands.cli import main
from tests import ROOT
from tests.docs.pages import blocks

PAGE = ROOT / "docs" / "troubleshooting.md"

FILES = {
    "car.toml": "J_1 = 0.05\nmass = 1500\n",
    "contradictory.toml": "C = 220.0\nk_s = 25800.0\n",
    "torque_alone.csv": "time [s],T_ref [N.m]\n0,10\n0.01,12\n",
    "no_unit.csv": "time [s],T_mot [N.m],speed\n0,10,20\n0.01,12,20\n0.02,12,20\n",
    "not_in_order.csv": "time [s],T_mot [N.m],v [km/h]\n0,10,20\n0.02,12,20\n0.01,12,20\n",
    "gap.csv": "time [s],T_mot [N.m],v [km/h]\n0,10,20\n0.01,12,20\n0.02,12,20\n5,12,20\n",
    "not_a_number.csv": "time [s],T_mot [N.m],v [km/h]\n0,10,20\n0.01,x,20\n0.02,12,20\n",
}
"""What the commands of the page are given."""

SAID = list(blocks(PAGE, "console"))
QUOTED = [line for block in blocks(PAGE, "text") for line in block.splitlines()]

LEAST = 10
"""Characters that a message must share with the text in the code, at its places and in its order."""


@pytest.mark.parametrize("block", SAID, ids=lambda block: block.partition("\n")[0])
def test_a_command_says_what_the_page_shows(
    block: str, built: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, content in FILES.items():
        (tmp_path / name).write_text(content, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    line, _, message = block.partition("\n")
    arguments = shlex.split(line)[2:]
    where = [] if "--fmus" in arguments or arguments[0] not in ("simulate", "replay") else ["--fmus", str(built)]
    assert answer([*arguments, *where]) == 2
    assert capsys.readouterr().err == message


def answer(arguments: list[str]) -> int | str | None:
    try:
        return main(arguments)
    except SystemExit as end:
        return end.code


@cache
def templates() -> list[re.Pattern[str]]:
    """Every text in the code that has so many characters of its own, with anything where it is filled in."""
    return [
        re.compile("".join(".+" if part is None else re.escape(part) for part in parts))
        for package in ("models", "fmus", "harness")
        for path in (ROOT / package).rglob("*.py")
        for parts in texts(ast.parse(path.read_bytes()))
        if sum(len(part) for part in parts if part) >= LEAST
    ]


def texts(tree: ast.AST) -> Iterator[list[str | None]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            yield [str(part.value) if isinstance(part, ast.Constant) else None for part in node.values]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            pieces = re.split(r"%(?:s|d|g|\.\d[fg])", node.value)
            yield [piece for k, part in enumerate(pieces) for piece in ((None, part) if k else (part,))]


def is_said(message: str) -> bool:
    message = re.sub(r"^driveline \w+: ", "", message)
    return any(template.fullmatch(message) for template in templates())


@pytest.mark.parametrize("message", QUOTED)
def test_a_message_that_is_quoted_is_one_of_the_code(message: str) -> None:
    assert is_said(message)


@pytest.mark.parametrize("message", QUOTED)
def test_a_message_with_other_words_is_found_out(message: str) -> None:
    words = message.split()
    changed = [" ".join((*words[:k], "otherwise", *words[k + 1 :])) for k in range(2, len(words))]
    assert not all(map(is_said, changed))


def test_the_page_explains_twenty_messages_and_more() -> None:
    assert len(SAID) + len(QUOTED) >= 20

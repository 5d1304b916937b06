"""The pages of the documentation and what stands in them."""

import re
import shlex
from collections.abc import Iterator
from pathlib import Path

from tests import ROOT

PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").glob("*.md")), *sorted((ROOT / "docs").glob("c*/*.md"))]

BLOCK = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```$", re.M | re.S)
INLINE = re.compile(r"`([^`\n]+)`")


def text_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def prose(page: Path) -> str:
    """A page without its blocks of code."""
    return BLOCK.sub("", text_of(page))


def blocks(page: Path, *languages: str) -> Iterator[str]:
    """Its blocks of code in one of the languages."""
    yield from (code for language, code in BLOCK.findall(text_of(page)) if language in languages)


def commands(script: str) -> Iterator[list[str]]:
    """The arguments of each `driveline` in lines of a shell, up to what the shell does with its output."""
    for line in script.replace("\\\n", " ").splitlines():
        words = shlex.split(line.removeprefix("$ "), comments=True)
        if words[:1] == ["driveline"] and "--print-completion" not in words:
            ends = [k for k, word in enumerate(words) if word in (">", "|", "&&", ";")]
            yield words[1 : min(ends, default=len(words))]

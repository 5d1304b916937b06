"""A page for each room of the packages: what stands in the docstrings of its modules."""

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path

from docs.site import ROOT

FOLDER = "reference"
PACKAGES = ("harness", "fmus", "models")
ELSEWHERE = "driveline.harness.commands"
"""Has pages of its own, made from the parsers."""


def pages() -> Mapping[str, str]:
    """The pages, by their path in the site; they tell mkdocstrings which modules to show."""
    rooms = {room: list(_modules(room)) for package in PACKAGES for room in _rooms(package) if room != ELSEWHERE}
    return {f"{FOLDER}/index.md": _index(list(rooms))} | {
        f"{FOLDER}/{room}.md": _page(room, modules) for room, modules in rooms.items()
    }


def _rooms(package: str) -> Iterator[str]:
    for path in sorted((ROOT / package).rglob("__init__.py")):
        yield ".".join(path.parent.relative_to(ROOT).parts)


def _modules(room: str) -> Iterator[str]:
    for path in sorted(ROOT.joinpath(*room.split(".")).glob("*.py")):
        if not path.stem.startswith("__"):
            yield f"{room}.{path.stem}"


def _docstring(path: Path) -> str:
    return ast.get_docstring(ast.parse(path.read_bytes())) or ""


def _about(room: str) -> str:
    return _docstring(ROOT.joinpath(*room.split("."), "__init__.py"))


def _index(rooms: list[str]) -> str:
    first = {room: " ".join(_about(room).partition("\n\n")[0].split()) for room in rooms}
    rows = [f"| [`{room}`]({room}.md) | {text} |" for room, text in first.items()]
    head = ["# Reference of the Python packages", "", "From the docstrings; all quantities are in SI units.", ""]
    return "\n".join([*head, "| package | what is in it |", "|---|---|", *rows, ""])


def _page(room: str, modules: list[str]) -> str:
    return "\n\n".join([f"# {room}", _about(room), *(f"::: {module}" for module in modules)]) + "\n"

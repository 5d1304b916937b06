"""The reference of the module `driveline`: a page for each group of its names, from their docstrings."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import NamedTuple

from docs.site import ROOT

FOLDER = "reference"
PACKAGE = ROOT / "driveline"
INSIDE = ("models", "fmus", "harness")
"""Folders of the checkout that are packages of `driveline` where it is installed."""


class Group(NamedTuple):
    """Names that belong together, as `__init__.pyi` has them below a comment `# Title: what they are for`."""

    title: str
    about: str
    names: list[str]

    @property
    def page(self) -> str:
        """Its path in the site."""
        return f"{FOLDER}/{self.title.lower().replace(' ', '_')}.md"


def groups() -> Iterator[Group]:
    """All of them, in their order."""
    for paragraph in (PACKAGE / "__init__.pyi").read_text(encoding="utf-8").split("\n\n"):
        head, *imports = paragraph.strip().splitlines()
        title, _, about = head.removeprefix("# ").partition(": ")
        yield Group(title, about, [line.rpartition(" as ")[2] for line in imports])


def pages() -> Mapping[str, str]:
    """The pages, by their path in the site; they tell mkdocstrings which names to show."""
    return {f"{FOLDER}/index.md": _index()} | {group.page: _page(group) for group in groups()}


def _index() -> str:
    rows = [
        f"| [{group.title}]({group.page.rpartition('/')[2]}) | {group.about} | {_names(group)} |" for group in groups()
    ]
    text = (
        "`import driveline` is all there is to import. What is listed here is public; everything else can change from "
        "one release to the next. All quantities are in SI units."
    )
    return "\n".join(
        ["# Reference of the Python module", "", text, "", "| group | for | names |", "|---|---|---|", *rows, ""]
    )


def _names(group: Group) -> str:
    page = group.page.rpartition("/")[2]
    return ", ".join(f"[`{name}`]({page}#driveline.{name})" for name in group.names)


def _page(group: Group) -> str:
    about = f"{group.about[:1].upper()}{group.about[1:]}."
    return "\n\n".join([f"# {group.title}", about, *(f"::: driveline.{name}" for name in group.names)]) + "\n"


def link_packages() -> None:
    """Links the folders of the checkout into the package, so that mkdocstrings, which runs nothing, reads it as it is
    installed."""
    for folder in INSIDE:
        with suppress(FileExistsError):
            (PACKAGE / folder).symlink_to(f"../{folder}")

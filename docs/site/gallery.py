"""The gallery: every figure of the documentation with the command that makes it."""

import re
from collections.abc import Iterator
from fnmatch import fnmatch
from typing import NamedTuple

from docs.site import ROOT, links
from docs.studies.pages import PAGES

PAGE = "gallery.md"
FIGURES = ROOT / "docs" / "figures"

SHOWN = re.compile(r"!\[([^\]]*)\]\((?:docs/)?figures/([^)]+)\)")


class Figure(NamedTuple):
    """A figure as a page of the site shows it."""

    name: str
    caption: str
    page: str


def command(name: str) -> str:
    """What makes a figure; nothing for a drawing.

    Raises:
        LookupError: it is not known.
    """
    for made in PAGES.values():
        if any(fnmatch(f"figures/{name}", pattern) for pattern in made.writes):
            return made.command
    if name.endswith(".svg"):
        return ""
    raise LookupError(f"docs/figures/{name}: no command makes it")


def figures() -> Iterator[Figure]:
    """All that pages show, page by page."""
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))):
        text = path.read_text(encoding="utf-8")
        page = links.PAGES.get(path.name, path.name)
        for caption, name in SHOWN.findall(text):
            yield Figure(name, caption, page)


def page() -> str:
    """The page in Markdown."""
    lines = [
        "# Gallery",
        "",
        "Every figure of the documentation, where it is explained, and the command that makes it.",
    ]
    by_command: dict[str, list[Figure]] = {}
    for figure in figures():
        by_command.setdefault(command(figure.name), []).append(figure)
    for made_by, shown in sorted(by_command.items(), key=lambda each: not each[0]):
        lines += ["", f"## {made_by or 'Drawn by hand'}", ""]
        if made_by:
            lines += ["```sh", made_by, "```", ""]
        for figure in shown:
            image = f"![{figure.caption}](figures/{figure.name})"
            lines += [
                f"{image}{{ loading=lazy }}",
                "",
                f"`{figure.name}`: {figure.caption}, in [{links.title(figure.page)}]({figure.page})",
                "",
            ]
    return "\n".join(lines)

"""Links that lead out of docs: on the site to the page or the file that it has of them."""

import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from docs.site import ROOT

PAGES = {
    "README.md": "index.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "SECURITY.md": "security.md",
}
"""Pages of the repository, with the place of each in the site."""

FILES = "files"
"""Folder of the site for other files of the repository that pages link to."""

LINK = re.compile(r"(?<=\]\()(?!#|[a-z]+:)([^)#\s]+)")

NAME = re.compile(r"(?<=\[)(?:docs/)?(\w+\.md)(?=\]\()")
"""Of a page, as the text of a link to it."""


def source(page: str) -> Path:
    """The file in the checkout that a page of the site is made from."""
    return next((ROOT / name for name, place in PAGES.items() if place == page), ROOT / "docs" / page)


def title(page: str) -> str:
    """The heading of a page of the site that is in the checkout."""
    return source(page).read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ")


def fitted(text: str, page: str) -> str:
    """Markdown of a page with its links as they are on the site: pages are called by their titles there.

    Args:
        page: its path in the site.
    """
    text = LINK.sub(lambda found: _relative(place(found[1], page), page), text)
    return NAME.sub(lambda found: title(PAGES.get(found[1], found[1])), text)


def place(link: str, page: str) -> str:
    """Where in the site a relative link of a page leads to."""
    target = Path(os.path.normpath(source(page).parent / link))
    if target.is_relative_to(ROOT / "docs"):
        return target.relative_to(ROOT / "docs").as_posix()
    name = target.relative_to(ROOT).as_posix()
    return PAGES.get(name, f"{FILES}/{name}")


def files(pages: Mapping[str, str]) -> Iterator[str]:
    """The files of the repository that pages link to and that are neither pages nor in docs."""
    places = {place(link, page) for page, text in pages.items() for link in LINK.findall(text)}
    for each in sorted(places):
        if each.startswith(f"{FILES}/"):
            yield each.removeprefix(f"{FILES}/")


def _relative(target: str, page: str) -> str:
    return os.path.relpath(target, os.path.dirname(page) or ".").replace(os.sep, "/")

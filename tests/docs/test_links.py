"""Links lead somewhere, on GitHub as on the site."""

import re
from pathlib import Path

import pytest

from tests import ROOT
from tests.docs.pages import PAGES, named, prose, text_of

LINK = re.compile(r"\]\((?![a-z]+:)([^)#\s]*)(#[^)\s]*)?\)")


def anchors(page: Path) -> set[str]:
    """Of the headings of a page, as GitHub makes them."""
    headings = re.findall(r"^#+ (.+)$", prose(page), re.M)
    return {"#" + re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", sorted((ROOT / "docs").glob("*.md")), ids=named)
def test_a_page_has_its_place_on_the_site(page: Path) -> None:
    assert re.search(rf"^ +- {page.name}$", text_of(ROOT / "mkdocs.yml"), re.M), "mkdocs.yml, nav"


LIST = ROOT / "docs" / "pages.md"


@pytest.mark.parametrize("page", sorted({*(ROOT / "docs").glob("*.md")} - {LIST}), ids=named)
def test_a_page_is_in_the_list_of_pages(page: Path) -> None:
    assert re.search(rf"^\| \[{page.name}\]\({page.name}\) \| .+ \|$", text_of(LIST), re.M)


def test_the_readme_is_one_screen() -> None:
    assert len(text_of(ROOT / "README.md").splitlines()) <= 120


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_links_lead_to_files_and_headings(page: Path) -> None:
    for file, anchor in LINK.findall(prose(page)):
        target = (page.parent / file).resolve() if file else page
        assert target.exists(), file
        if anchor:
            assert anchor in anchors(target), f"{file}{anchor}"

"""The built site: strict, complete, as GitHub shows the pages, and without network."""

import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path

import pytest
from markdown_it import MarkdownIt

import driveline
from tests import ROOT
from tests.browser import Browser
from tests.docs.pages import text_of

DOCS = sorted((ROOT / "docs").glob("*.md"))

LOADING = {"script": "src", "link": "href", "img": "src", "iframe": "src", "source": "src", "video": "src"}
"""Elements that load something, with the attribute that says what."""

COUNTED = ("h1", "h2", "h3", "h4", "li", "table", "td", "th", "pre", "img", "strong", "blockquote")
"""What a page has as many of on the site as on GitHub."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the built site."""
    lacking = [
        name for name in ("mkdocs", "material", "mkdocstrings", "latex2mathml", "ziamath") if not find_spec(name)
    ]
    if lacking:
        pytest.skip(f"no {', '.join(lacking)}: `make site` installs the extra `site`")
    folder = tmp_path_factory.mktemp("site")
    build = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)]
    done = subprocess.run(
        build, cwd=ROOT, env=os.environ | {"NO_MKDOCS_2_WARNING": "1"}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return folder


class Elements(HTMLParser):
    """The elements of a page, those of its text alone or all."""

    def __init__(self, page: str, of_text: bool = False) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str]]] = []
        self._open = not of_text
        self.feed(page)

    def handle_starttag(self, tag, attrs) -> None:
        self._open = self._open or tag == "article"
        if self._open:
            self.found.append((tag, {name: value or "" for name, value in attrs}))

    def handle_endtag(self, tag) -> None:
        self._open = self._open and tag != "article"


def counted(elements: Elements) -> Counter[str]:
    return Counter(tag for tag, _ in elements.found if tag in COUNTED)


def pages(site: Path) -> Iterator[tuple[str, str]]:
    for path in sorted(site.rglob("*.html")):
        yield path.relative_to(site).as_posix(), path.read_text(encoding="utf-8")


def test_no_page_loads_anything_from_elsewhere(site: Path) -> None:
    for name, page in pages(site):
        for tag, attributes in Elements(page).found:
            address = attributes.get(LOADING.get(tag, ""), "")
            assert not re.match(r"(https?:)?//", address), f"{name}: {tag} {address}"
    for path in site.rglob("*.css"):
        assert not re.search(r"(url\(|@import)\s*['\"]?(https?:)?//", path.read_text(encoding="utf-8")), path.name


@pytest.mark.parametrize("page", DOCS, ids=lambda page: page.name)
def test_a_page_is_what_github_shows(site: Path, page: Path) -> None:
    github = Elements(MarkdownIt("commonmark").enable("table").render(text_of(page)))
    here = Elements((site / f"{page.stem}.html").read_text(encoding="utf-8"), of_text=True)
    assert counted(here) == counted(github)


def test_equations_are_mathml(site: Path) -> None:
    written = (site / "derivation.html").read_text(encoding="utf-8")
    source = text_of(ROOT / "docs" / "derivation.md")
    assert written.count('<math xmlns="http://www.w3.org/1998/Math/MathML" display="block"') == source.count("$$") / 2
    assert "arithmatex" not in written
    for _, page in pages(site):
        assert not any("\\" in text for text in re.findall(r"<m[ion][^>]*>([^<]*)</m[ion]>", page))


def test_every_page_is_found_by_searching(site: Path) -> None:
    index = (site / "search" / "search_index.js").read_text(encoding="utf-8")
    for name, _ in pages(site):
        assert f'"location":"{name}"' in index or name == "404.html", name


def test_the_reference_has_every_public_name_and_no_other_module(site: Path) -> None:
    shown, text = set(), ""
    for path in (site / "reference").glob("*.html"):
        page = path.read_text(encoding="utf-8")
        shown |= set(re.findall(r'<h2 id="driveline\.(\w+)"', page))
        text += page
    assert shown == set(dir(driveline))
    assert not re.findall(r'id="driveline\.(?:harness|models|fmus)', text)
    assert "Drives the closed loop through a manoeuvre." in text


def test_a_browser_shows_it_from_files(site: Path, chromium: Browser) -> None:
    chromium.chrome.get((site / "derivation.html").as_uri())
    chromium.until("document.fonts.status === 'loaded'")
    assert chromium.js("[...document.fonts].some((font) => font.family.includes('STIX') && font.status === 'loaded')")
    assert chromium.js("document.querySelector('.md-typeset math mtable').getBoundingClientRect().height") > 40
    find = "[data-md-component=search-query]"
    chromium.chrome.execute_script(f"document.querySelector('{find}').focus()")
    chromium.chrome.find_element("css selector", find).send_keys("backlash")
    chromium.until("document.querySelectorAll('.md-search-result__item').length > 3")
    assert chromium.console() == []


@pytest.mark.parametrize("page", ["index", "derivation", "gallery", "commands/target", "reference/run"])
def test_a_browser_fetches_nothing_for_a_page(site: Path, chromium: Browser, page: str) -> None:
    for log in ("browser", "performance"):
        chromium.chrome.get_log(log)
    chromium.chrome.get((site / f"{page}.html").as_uri())
    chromium.until("document.readyState === 'complete'")
    fetched = chromium.fetched()
    assert any(address.endswith(f"{page}.html") for address in fetched)
    assert all(address.startswith("file:") for address in fetched)
    assert chromium.console() == []


WIDER = """\
[...document.querySelectorAll('article table')].filter((table) =>
  Math.max(table.scrollWidth, table.getBoundingClientRect().width)
    > (table.closest('.md-typeset__scrollwrap') ?? table.parentElement).clientWidth + 1
).map((table) => table.rows[0].innerText)
"""
"""The headings of the tables of a page that are wider than the place that they have."""


@pytest.mark.parametrize("page", [page.stem for page in DOCS if "| --" in text_of(page) or "|--" in text_of(page)])
def test_tables_are_whole_on_a_screen_of_1280_pixels(site: Path, chromium: Browser, page: str) -> None:
    chromium.chrome.set_window_size(1280, 900)
    chromium.chrome.get((site / f"{page}.html").as_uri())
    chromium.until("document.querySelectorAll('.md-typeset__scrollwrap').length > 0")
    assert chromium.js(WIDER) == []

"""The built site: complete, as GitHub shows the pages, and without network. `mkdocs build --strict` holds its links."""

import os
import re
import subprocess
import sys
from collections import Counter
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path

import pytest
from markdown_it import MarkdownIt

import driveline
from docs.site import explored
from tests import ROOT
from tests.browser import Browser
from tests.docs.pages import text_of

pytestmark = pytest.mark.slow  # builds it, for 20 s

DOCS = [path for path in sorted((ROOT / "docs").rglob("*.md")) if not {"site", "studies"} & {*path.parts}]

LOADING = {"script": "src", "link": "href", "img": "src", "iframe": "src", "source": "src", "video": "src"}
"""Elements that load something, with the attribute that says what."""

COUNTED = ("h1", "h2", "h3", "h4", "li", "th", "pre", "img", "strong", "blockquote")
"""What a page of no numbers has as many of on the site as on GitHub."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the built site; the variable BUILT_SITE names one that is built already."""
    if given := os.environ.get("BUILT_SITE"):
        return Path(given)
    packages = ("mkdocs", "material", "mkdocstrings", "latex2mathml", "ziamath")
    if lacking := [name for name in packages if not find_spec(name)]:
        pytest.skip(f"no {', '.join(lacking)}: `make site` installs the extra `site`")
    folder = tmp_path_factory.mktemp("site")
    build = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)]
    environment = os.environ | {"NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run(build, cwd=ROOT, env=environment, capture_output=True, text=True)
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


def test_no_page_loads_anything_from_elsewhere_and_every_one_is_found_by_searching(site: Path) -> None:
    index = text_of(site / "search" / "search_index.js")
    for path in sorted(site.rglob("*.html")):
        name = path.relative_to(site).as_posix()
        for tag, attributes in Elements(text_of(path)).found:
            address = attributes.get(LOADING.get(tag, ""), "")
            assert not re.match(r"(https?:)?//", address), f"{name}: {tag} {address}"
        assert f'"location":"{name}"' in index or name in ("404.html", explored.PAGE), name
    for path in site.rglob("*.css"):
        assert not re.search(r"(url\(|@import)\s*['\"]?(https?:)?//", text_of(path)), path.name


def test_a_page_is_what_github_shows_and_its_equations_are_mathml(site: Path) -> None:
    for page in DOCS:
        github = Elements(MarkdownIt("commonmark").enable("table").render(text_of(page)))
        here = Elements(text_of((site / page.relative_to(ROOT / "docs")).with_suffix(".html")), of_text=True)
        assert "\n[table: " in text_of(page) or counted(here) == counted(github), page
    for page in DOCS:
        written = text_of((site / page.relative_to(ROOT / "docs")).with_suffix(".html"))
        equations = written.count('<math xmlns="http://www.w3.org/1998/Math/MathML" display="block"')
        assert equations == text_of(page).count("$$") / 2, page
        assert "arithmatex" not in written
        assert not any("\\" in text for text in re.findall(r"<m[ion][^>]*>([^<]*)</m[ion]>", written))


def test_the_reference_has_every_public_name_and_no_other_module(site: Path) -> None:
    text = "".join(text_of(path) for path in (site / "reference").glob("*.html"))
    assert set(re.findall(r'<h2 id="driveline\.(\w+)"', text)) == set(dir(driveline))
    assert not re.findall(r'id="driveline\.(?:harness|models|fmus)', text)
    assert "Drives the closed loop through a manoeuvre." in text


WIDER = """\
[...document.querySelectorAll('article table')].filter((table) =>
  Math.max(table.scrollWidth, table.getBoundingClientRect().width)
    > (table.closest('.md-typeset__scrollwrap') ?? table.parentElement).clientWidth + 1
).map((table) => table.rows[0].innerText)
"""
"""The headings of the tables of a page that are wider than the place that they have."""


def test_a_browser_shows_it_from_files_without_network_and_whole(site: Path, chromium: Browser) -> None:
    chromium.chrome.set_window_size(1280, 900)
    written = [(site / page.relative_to(ROOT / "docs")).with_suffix(".html") for page in DOCS]
    made = [site / f"{name}.html" for name in ("index", "gallery", "commands/target", "reference/run")]
    for path in (*written, *made):
        for log in ("browser", "performance"):
            chromium.chrome.get_log(log)
        chromium.chrome.get(path.as_uri())
        chromium.until("document.readyState === 'complete'")
        fetched = chromium.fetched()
        assert any(address.endswith(path.name) for address in fetched)
        assert all(address.startswith(("file:", "blob:file:", "blob:null")) for address in fetched)
        assert chromium.console() == []
        if path in written and "<table" in text_of(path).partition("<article")[2]:
            chromium.until("document.querySelectorAll('.md-typeset__scrollwrap').length > 0")
            assert chromium.js(WIDER) == [], path.name


def test_a_browser_has_the_font_of_equations_and_searches(site: Path, chromium: Browser) -> None:
    chromium.chrome.get((site / "control.html").as_uri())
    chromium.until("document.fonts.status === 'loaded'")
    find = "[data-md-component=search-query]"
    chromium.chrome.execute_script(f"document.querySelector('{find}').focus()")
    chromium.chrome.find_element("css selector", find).send_keys("backlash")
    chromium.until("document.querySelectorAll('.md-search-result__item').length > 3")
    page = next(path for path in DOCS if "\\begin{" in text_of(path))
    chromium.chrome.get((site / page.relative_to(ROOT / "docs")).with_suffix(".html").as_uri())
    chromium.until("document.fonts.status === 'loaded'")
    assert chromium.js("[...document.fonts].some((font) => font.family.includes('STIX') && font.status === 'loaded')")
    assert chromium.js("document.querySelector('.md-typeset math mtable').getBoundingClientRect().height") > 40

"""Tables, figures and single numbers of studies in the pages of the site, from docs/studies/data.

A paragraph `[table: STUDY/TABLE](studies/data/STUDY.json)` becomes the table, `[figure: STUDY/FIGURE](...)` the figure,
and `[70 ms](studies/data/STUDY.json#TABLE/ROW/COLUMN)` is a number of which a test says that the file has it. What
comes from declarations is `[table: NAME](the file that declares it)`.
"""

import re
from collections.abc import Iterable, Iterator
from functools import cache
from itertools import takewhile
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from docs.site.declared import TABLES
from docs.studies import data_file
from docs.studies.data_file import Kept
from docs.studies.study import Cell, Column, Table, number
from driveline.harness.views.figure_options import FigureOptions
from driveline.harness.views.figure_style import draw
from driveline.harness.views.markdown import markdown_table
from toolground.plain_text import printed

SHOWN = re.compile(r"^\[(table|figure): (\w+)(?:/([^\]]+))?\]\([^)\s]+\)$", re.M)
"""A paragraph that stands for a table or a figure."""

INLINE = re.compile(r"\[([^\]\[]+)\]\((?:\.\./)*(?:docs/)?studies/data/(\w+)\.json#([^)\s]+)\)")
"""A number in a sentence, with study and place."""

TYPED = re.compile(
    r"\|\s*([-+<>≤≥]?\s*\d[\d.,]*(?: (?:to|instead of) [\d.,]+)?(?:\.\d+| ?(?:%|m?s|N[·.]m|Hz|rad/s|kB|MB)))\s*(?=\|)"
)
"""A cell of a table that is a measured number, written by hand: it has a decimal fraction or a unit."""

FIGURES = "figures/studies"
"""Folder of the site for figures of studies."""


class Place(NamedTuple):
    """Where a number stands."""

    table: str
    row: str
    column: str


@cache
def kept(study: str) -> Kept:
    """What a study has measured."""
    return data_file.read(study)


def shown(text: str, up: str = "") -> str:
    """Markdown of a page with its tables, figures and numbers.

    Args:
        up: from the page to the top of the site.
    """

    def paragraph(found: re.Match[str]) -> str:
        kind, study, name = found.groups()
        if kind == "table":
            return TABLES[study]() if name is None else measured_table(study, name)
        return f"![{name}]({up}{FIGURES}/{study}_{name}.png){{ loading=lazy }}\n\n*{kept(study).origin}*"

    def sentence(found: re.Match[str]) -> str:
        return f'<span title="{kept(found[2]).origin}">{found[1]}</span>'

    return INLINE.sub(sentence, SHOWN.sub(paragraph, text))


def measured_table(study: str, name: str) -> str:
    """A table of a study with what it was measured with."""
    table = kept(study).measured.tables[name]
    below = " ".join(filter(None, (table.note, f"`{study}`, {kept(study).origin}.")))
    return f"{as_markdown(table)}\n\n*{below}*"


def as_markdown(table: Table) -> str:
    """Words to the left, numbers to the right."""
    headings = [f"{each.name}, {printed(each.unit)}" if each.unit else each.name for each in table.columns]
    rows = [
        [_escaped(row), *(_escaped(number(cell, of)) for cell, of in zip(cells, table.columns, strict=True))]
        for row, cells in table.rows.items()
    ]
    words = [any(isinstance(cells[k], str) for cells in table.rows.values()) for k in range(len(table.columns))]
    return markdown_table([table.label, *headings], rows, labels=1 + len([*takewhile(bool, words)]))


def _escaped(text: str) -> str:
    return text.replace("|", r"\|")


def figures(pages: Iterable[str]) -> Iterator[tuple[str, bytes]]:
    """The figures that pages show: place in the site, and content."""
    wanted = {(found[2], found[3]) for text in pages for found in SHOWN.finditer(text) if found[1] == "figure"}
    with TemporaryDirectory() as folder:
        for study, name in sorted(wanted):
            drawing = kept(study).measured.figures[name]
            (path,) = draw(drawing, Path(folder) / f"{study}_{name}", FigureOptions(kinds=("png",)))
            yield f"{FIGURES}/{path.name}", path.read_bytes()


def slug(text: str) -> str:
    """A name as it stands in a link."""
    return re.sub(r"[^\w.]+", "-", text).strip("-")


def value_at(study: str, place: str) -> tuple[Cell, Column]:
    """The cell that a link leads to, with its column.

    Raises:
        LookupError: there is none.
    """
    parts = place.split("/")
    if len(parts) != len(Place._fields):
        raise LookupError(f"{study}.json#{place}: not TABLE/ROW/COLUMN")
    found = Place(*parts)
    for name, table in kept(study).measured.tables.items():
        for row, cells in table.rows.items():
            for cell, column in zip(cells, table.columns, strict=True):
                if (slug(name), slug(row), slug(column.name)) == found:
                    return cell, column
    raise LookupError(f"{study}.json#{place}: no such cell")


NUMBER = re.compile(r"[-−]?\d+(?:\.\d+)?")


def disagreements(text: str) -> Iterator[str]:
    """The numbers of a page that are not those of their studies, to the digits that the page has."""
    for told, study, place in INLINE.findall(text):
        value, _ = value_at(study, place)
        found = NUMBER.search(told)
        if value is None or isinstance(value, str) or found is None:
            same = str(value) == told
        else:
            said = found[0].replace("−", "-")
            digits = len(said.partition(".")[2])
            same = abs(float(said) - value) <= 0.5000001 * 10.0**-digits
        if not same:
            yield f"{told!r}: {study}.json#{place} has {value}"

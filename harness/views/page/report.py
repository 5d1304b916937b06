"""The page of a report: one file that needs nothing else, written when it is complete; its sections and tables."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

from toolground.atomic_files import complete
from toolground.errors import UserError

from ...metrics.declaration import Column, Metric
from .document import HERE, document
from .figures import Arrays, Figure, figure_data


@dataclass(frozen=True)
class Section:
    """A part of the page: a table, figures, or both, under a heading; with a sentence on how to read them."""

    heading: str
    text: str = ""
    table: "Table | None" = None
    figures: Sequence[Figure] = ()


def require_report(path: Path | None) -> None:
    """Refuses a report that cannot be written, before anything is run.

    Raises:
        UserError: it is no .html.
    """
    if path is not None and path.suffix.lower() not in (".html", ".htm"):
        raise UserError(f"--report {path}: a report is a .html file")


def write_report(
    title: str, verdict: str, sections: Sequence[Section], provenance: Mapping[str, Any], path: Path
) -> None:
    """Writes the page.

    Args:
        verdict: one sentence.
        provenance: what made the results, as `harness.simulation.provenance.content` says it.
    """
    arrays, drawn, body = Arrays(), list[Any](), [f'<h1>{escape(title)}</h1>\n<p class="verdict">{escape(verdict)}</p>']
    for section in sections:
        body += [f"<h2>{escape(section.heading)}</h2>", *_text(section.text)]
        body += list(_table(section.table)) if section.table else []
        for figure in section.figures:
            body.append(f'<div id="figure {len(drawn)}"></div>')
            drawn.append(figure_data(figure, arrays))
    known = facts(provenance)
    body += [
        "<h2>What made this</h2>",
        f"<details><summary>{escape(known[0][1])}: version, command line, FMUs and settings</summary>",
        *_terms(known),
        "</details>",
    ]
    data = {"arrays": arrays.texts, "figures": drawn}
    page = document(title, "\n".join(body), data, [HERE / "report.js"], [HERE / "report.css"])
    with complete(path) as unfinished:
        unfinished.write_text(page, encoding="utf-8")


def _text(text: str) -> list[str]:
    return [f'<p class="text">{escape(text)}</p>'] if text else []


def _terms(terms: Iterable[tuple[str, str]]) -> list[str]:
    return ["<dl>", *(f"<dt>{escape(term)}</dt><dd>{escape(meaning)}</dd>" for term, meaning in terms), "</dl>"]


def _table(table: "Table") -> Iterator[str]:
    kinds = ["" if heading.number else ' class="word"' for heading in table.headings]
    yield '<div class="scroll"><table><thead><tr>'
    for heading, kind in zip(table.headings, kinds, strict=True):
        title = f' title="{escape(heading.meaning)}"' if heading.meaning else ""
        yield f"<th{title}{kind}>{escape(heading.text)}</th>"
    yield "</tr></thead><tbody>"
    for row in table.rows:
        choice = f' data-choice="{escape(row.choice)}"' if row.choice else ""
        muted = ' class="muted"' if row.muted else ""
        cells = zip(row.cells, kinds, row.shades or [""] * len(kinds), strict=True)
        yield f"<tr{choice}{muted}>{''.join(_cell(*cell) for cell in cells)}</tr>"
    yield "</tbody></table></div>"
    for note in table.notes:
        yield from _text(note)
    if explained := [(heading.text, heading.meaning) for heading in table.headings if heading.meaning]:
        yield from ("<details><summary>What the columns mean</summary>", *_terms(explained), "</details>")


def _cell(text: str, kind: str, shade: str) -> str:
    coloured = f' class="share" style="background:{shade}"' if shade else kind
    return f"<td{coloured}>{escape(text)}</td>"


def facts(content: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Names and values.

    Args:
        content: as `harness.simulation.provenance.content` gives it.
    """
    return [
        ("program", str(content["program"])),
        ("commit", str(content["commit"] or "not of a checkout")),
        ("command line", str(content["command_line"])),
        *_fmus(content["fmus"]),
        *((f"input {path}", digest) for path, digest in content["inputs"].items()),
        *_flat(content["run"], ()),
    ]


def _fmus(plants: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    for plant, fmus in plants.items():
        for name, fmu in fmus.items():
            yield f"FMU {name} ({plant})", f"{fmu['file']} {fmu['digest']}"


def _flat(value: Any, names: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """What was set, a line for each value; what was not is left out."""
    if isinstance(value, Mapping):
        for name, each in value.items():
            if name not in ("fmus", "start_values"):
                yield from _flat(each, (*names, str(name)))
    elif value not in (None, "", [], ()):
        yield " ".join(names), ", ".join(map(str, value)) if isinstance(value, list) else str(value)


class Heading(NamedTuple):
    """Of a column of words, or of numbers, which stand to the right; with what it means."""

    text: str
    meaning: str = ""
    number: bool = False


class Row(NamedTuple):
    """Cells, what the figures show when the row is clicked, if anything, and the colours of cells that have one."""

    cells: Sequence[str]
    choice: str = ""
    muted: bool = False
    shades: Sequence[str] = ()


@dataclass(frozen=True)
class Table:
    headings: Sequence[Heading]
    rows: Sequence[Row]
    notes: Sequence[str] = ()


def of_metrics(shown: Iterable[tuple[Metric, Column]]) -> Iterator[Heading]:
    """The headings of metrics as the tables show them."""
    for metric, column in shown:
        yield Heading(column.titled, f"{metric.description} ({metric.key} in files)", True)

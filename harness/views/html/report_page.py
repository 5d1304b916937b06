"""The page of a report: one file that needs nothing else, written when it is complete; its sections and tables."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ...base.atomic_files import complete
from ...base.errors import DrivelineError
from ...base.optional_packages import required
from ...metrics.declaration import Column, Metric

if TYPE_CHECKING:
    from bokeh.models import UIElement

EXTRA = "report"
"""Of the package, that installs what draws."""

TEMPLATE = Path(__file__).with_suffix(".html")

CHOICE = "choice"
"""Name of the control that chooses what the figures show; a row of a table sets it."""


@dataclass(frozen=True)
class Section:
    """A part of the page: a table, figures, or both, under a heading; with a sentence on how to read them."""

    heading: str
    text: str = ""
    table: "Table | None" = None
    figures: "Sequence[UIElement]" = ()


def require_report(path: Path | None) -> None:
    """Refuses a report that cannot be written, before anything is run; without one nothing is loaded.

    Raises:
        DrivelineError: it is no .html.
        MissingExtra: what draws is not installed.
    """
    if path is None:
        return
    if path.suffix.lower() not in (".html", ".htm"):
        raise DrivelineError(f"--report {path}: a report is a .html file")
    require_drawing("a report")


def require_drawing(what: str) -> None:
    """Refuses what is to be drawn where nothing can draw it.

    Raises:
        MissingExtra: it is not installed.
    """
    required("bokeh", what, EXTRA)


def write_report(
    title: str, verdict: str, sections: Sequence[Section], provenance: Mapping[str, Any], path: Path
) -> None:
    """Writes the page.

    Args:
        verdict: one sentence.
        provenance: what made the results, as `harness.simulation.provenance.content` says it.
    """
    from bokeh.embed import file_html
    from bokeh.resources import Resources
    from jinja2 import Environment

    models, ids = [], []
    for k, section in enumerate(sections):
        ids.append([])
        for j, model in enumerate(section.figures):
            model.name = model.name or f"figure_{k}_{j}"
            ids[-1].append(model.name)
            models.append(model)
    page = file_html(
        models,
        Resources(mode="inline", log_level="fatal"),
        title,
        template=Environment(autoescape=True).from_string(TEMPLATE.read_text(encoding="utf-8")),
        template_variables={
            "verdict": verdict,
            "sections": list(zip(sections, ids, strict=True)),
            "facts": facts(provenance),
            "choice": CHOICE,
        },
    )
    with complete(path) as unfinished:
        unfinished.write_text(page, encoding="utf-8")


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
    """Cells, and what the figures show when the row is clicked, if anything."""

    cells: Sequence[str]
    choice: str = ""
    muted: bool = False


@dataclass(frozen=True)
class Table:
    headings: Sequence[Heading]
    rows: Sequence[Row]
    notes: Sequence[str] = ()

    @property
    def explained(self) -> list[Heading]:
        """The headings that have a meaning."""
        return [heading for heading in self.headings if heading.meaning]


def of_metrics(shown: Iterable[tuple[Metric, Column]]) -> Iterator[Heading]:
    """The headings of metrics as the tables show them."""
    for metric, column in shown:
        yield Heading(f"{column.plain_heading}, {column.unit}", f"{metric.description} ({metric.key} in files)", True)

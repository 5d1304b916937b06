"""The page of a report: one file that needs nothing else, written when it is complete."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...base.atomic_files import complete
from ...base.errors import DrivelineError
from ...base.optional_packages import required
from .provenance_section import facts
from .report_tables import Table

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

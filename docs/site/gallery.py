"""The gallery: every figure of the documentation with the command that makes it."""

import re
from collections.abc import Iterator
from fnmatch import fnmatch
from typing import NamedTuple

from docs.site import ROOT, links

PAGE = "gallery.md"
FIGURES = ROOT / "docs" / "figures"

BY_HAND = ""

MADE_BY = {
    "drive.png": "driveline compare",
    "tutorial_*.png": "python -m docs.studies.tutorial_figures",
    "analysis_*.png": "driveline analyse",
    "calibration_*.png": "python -m docs.studies.calibration_page",
    "identification_simulation.png": "driveline identify results/record/ValidationVehicle_prbs_off.csv",
    "robustness_*.png": "driveline robustness --cases 300",
    "worst_*.png": "driveline robustness --cases 300",
    "faults.png": "driveline faults --cases 10000",
    "fault_pairs.png": "driveline faults --cases 10000",
    "bound.png": "driveline study bound",
    "front.png": "driveline design --search results/ours --evaluations 200",
    "target.png": "driveline target record",
    "*.svg": BY_HAND,
}
"""The command that makes figures with such names; the first that fits counts."""

SHOWN = re.compile(r"!\[([^\]]*)\]\((?:docs/)?figures/([^)]+)\)")


class Figure(NamedTuple):
    """A figure as a page of the site shows it."""

    name: str
    caption: str
    page: str


def command(name: str) -> str:
    """What makes a figure; BY_HAND where nothing does.

    Raises:
        LookupError: it is not known.
    """
    for pattern, made_by in MADE_BY.items():
        if fnmatch(name, pattern):
            return made_by
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
    for made_by, shown in sorted(by_command.items(), key=lambda each: each[0] == BY_HAND):
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

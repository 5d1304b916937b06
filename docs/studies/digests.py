"""Which pages are older than what they are made from.

A page depends on the code that its numbers pass through: the modules that its own ones import, the equations and the
C of its FMUs, and the data beside them, as far as they compute something (`code_digest.py`). What only draws, prints,
distributes or stores results does not count, nor do the versions of packages: they are pinned. `made.json` has the
digests with which each page was made; only making a page, or coming out the same when it is made again, puts them
there.

`stale.toml` says of pages that are stale and have not been made again why not, and what is known of the difference.
"""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path

from docs.studies.code_digest import digest
from docs.studies.imports import ROOT, reached, source
from docs.studies.pages import Page
from driveline.harness.base.atomic_files import write_text

MADE = Path(__file__).with_name("made.json")
STALE = Path(__file__).with_name("stale.toml")

NO_NUMBERS = (
    "docs.studies.imports",
    "fmus.archive",
    "fmus.description.documentation",
    "fmus.description.picture",
    "fmus.errors",
    "fmus.origin",
    "harness.base.atomic_files",
    "harness.base.collected_warnings",
    "harness.base.errors",
    "harness.base.interruption",
    "harness.base.known_names",
    "harness.base.optional_packages",
    "harness.base.plain_text",
    "harness.base.progress",
    "harness.base.status_line",
    "harness.commands",
    "harness.cosimulation.call_trace",
    "harness.cosimulation.isolated_process",
    "harness.cosimulation.limits",
    "harness.cosimulation.process_answers",
    "harness.cosimulation.process_host",
    "harness.loop.stale_fmus",
    "harness.metrics.notebook_table",
    "harness.simulation.case_archive",
    "harness.simulation.cluster",
    "harness.simulation.many_runs",
    "harness.simulation.provenance",
    "harness.simulation.same_fmus",
    "harness.simulation.workers",
    "harness.views",
)
"""Rooms and modules that numbers do not pass through; a page that depends on one nevertheless names it."""

DATA = (".c", ".h", ".csv", ".toml")
"""Files of a room that count, and in those of its folders that are no rooms."""


def why_stale(page: Page) -> list[str]:
    """The files that have changed, come or gone since a page was made; a sentence if that is not known."""
    if not (made := _made_with(page)):
        return ["it is not known what it was made from"]
    return sorted({file for file, _ in dependencies(page).items() ^ made.items()})


def dependencies(page: Page) -> dict[str, str]:
    """The digests of what a page is made from, by the files."""
    files = _made_with(page) if page.scores else (path.relative_to(ROOT).as_posix() for path in _files(page))
    return {file: digest(ROOT / file) for file in files if (ROOT / file).is_file()}


def record(page: Page, made_from: dict[str, str]) -> None:
    """Notes that a page has been made, and that it is stale no longer.

    Args:
        made_from: its dependencies before it was made.
    """
    made = json.loads(MADE.read_text(encoding="utf-8")) | {page.name: made_from}
    write_text(json.dumps(made, indent=1, sort_keys=True) + "\n", MADE)
    lines = STALE.read_text(encoding="utf-8").splitlines(keepends=True)
    write_text("".join(line for line in lines if not line.startswith(f"{page.name} = ")), STALE)


def reasons() -> dict[str, str]:
    """Why pages that are stale have not been made again, by their names."""
    return tomllib.loads(STALE.read_text(encoding="utf-8"))


def _made_with(page: Page) -> dict[str, str]:
    if page.scores:
        scores = json.loads((ROOT / page.scores).read_text(encoding="utf-8"))
        return {file: score["digest"] for file, score in scores.items()}
    return json.loads(MADE.read_text(encoding="utf-8")).get(page.name, {})


def _files(page: Page) -> Iterator[Path]:
    paths = {source(module) for module in reached(*page.modules, without=NO_NUMBERS)}
    yield from paths
    for path in paths:  # the text that a module fills
        yield from path.parent.glob(f"{path.stem}*.md")
    for room in {path.parent for path in paths}:
        folders = [room, *(path for path in room.iterdir() if path.is_dir() and not (path / "__init__.py").exists())]
        files = (path for folder in folders for path in folder.iterdir() if path.suffix in DATA)
        yield from (path for path in files if path != STALE)
    for pattern in page.files:
        yield from ROOT.glob(pattern)

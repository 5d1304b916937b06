"""The tables of docs/replay.md, those of `driveline replay`, between their marks."""

from pathlib import Path

from docs.studies.generated_sections import filled
from docs.studies.imports import ROOT

PAGE = ROOT / "docs" / "replay.md"


def make(folder: Path) -> None:
    tables = "\n\n".join(path.read_text(encoding="utf-8").strip() for path in sorted(folder.glob("*/*_table.md")))
    page = filled(PAGE.read_text(encoding="utf-8"), {"rides": tables})
    (folder / PAGE.name).write_text(page, encoding="utf-8")

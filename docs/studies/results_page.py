"""docs/results.md, the table of `driveline compare`."""

from pathlib import Path

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")


def make(folder: Path) -> None:
    table = (folder / "compare" / "table.md").read_text(encoding="utf-8")
    (folder / "results.md").write_text(PAGE.format(table=table), encoding="utf-8")

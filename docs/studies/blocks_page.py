"""docs/blocks.md, all blocks with their equations and variables."""

from pathlib import Path

from driveline.fmus.catalogue import FMUS
from driveline.fmus.description.documentation import tables, timing
from driveline.fmus.fmu import Fmu

HEAD = "# The blocks\n"
END = "Made by `python -m docs.studies blocks` from the declarations in `models/`; do not edit.\n"


def make(folder: Path) -> None:
    (folder / "blocks.md").write_text(page(), encoding="utf-8")


def page() -> str:
    """The page as Markdown."""
    return "\n".join([HEAD, *(_section(fmu) for fmu in FMUS.values()), END])


def _section(fmu: Fmu) -> str:
    parts = [f"## {fmu.name}", fmu.equations.strip(), timing(fmu.block)]
    for title, rows in tables(fmu.block):
        parts += [f"### {title}", _table(rows)]
    return "\n\n".join(parts) + "\n"


def _table(rows: list[tuple[str, ...]]) -> str:
    lines = [rows[0], ("---",) * len(rows[0]), *((f"`{name}`", *others) for name, *others in rows[1:])]
    escaped = ([cell.replace("|", r"\|") for cell in line] for line in lines)
    return "\n".join(f"| {' | '.join(line)} |" for line in escaped)

"""Writes docs/blocks.md, all blocks with their equations and variables: `python -m docs.studies.blocks_page`."""

from pathlib import Path

from driveline.fmus.catalogue import FMUS
from driveline.fmus.description.documentation import tables, timing
from driveline.fmus.fmu import Fmu

PATH = Path(__file__).parents[2] / "docs" / "blocks.md"

HEAD = "# The blocks\n"
END = "Made by `python -m docs.studies.blocks_page` from the declarations in `models/`; do not edit.\n"


def blocks_page() -> str:
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


if __name__ == "__main__":
    PATH.parent.mkdir(exist_ok=True)
    PATH.write_text(blocks_page(), encoding="utf-8")
    print(PATH)

"""The table of causes in docs/control.md, from the rows that the controller runs.

python -m docs.studies.causes
"""

import argparse
from pathlib import Path

from driveline.harness.base.interruption import script
from driveline.harness.views.markdown import markdown_table
from driveline.models.controller.causes import FAILURES, FEEDING, Cause
from driveline.models.damping_controller import BLOCK

from .generated_sections import filled

PAGE = Path(__file__).resolve().parents[1] / "control.md"


def after(row: Cause) -> str:
    return f"`{row.after}` ({getattr(BLOCK.Parameters(), row.after):g} s)" if row.after else "at once"


def causes() -> str:
    """The table in Markdown."""
    rows = [(str(row.number), f"`{row.word}`", row.finding, after(row), row.heals) for row in (*FAILURES, FEEDING)]
    return markdown_table(("number", "cause", "found", "counts after", "heals by"), rows, labels=5)


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.parse_args(arguments)
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), {"causes": causes()}), encoding="utf-8")


if __name__ == "__main__":
    script(main)

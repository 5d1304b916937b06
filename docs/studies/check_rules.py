"""The table of rules in docs/check.md, from their declarations.

python -m docs.studies.check_rules
"""

import argparse
from pathlib import Path

from driveline.harness.base.interruption import script
from driveline.harness.exchange.compliance.check import RULES
from driveline.harness.views.markdown import markdown_table

from .generated_sections import filled

PAGE = Path(__file__).resolve().parents[1] / "check.md"

HEADINGS = ("rule", "severity", "FMI 2.0", "FMI 3.0", "what an FMU does that keeps it")


def rules() -> str:
    """The table in Markdown."""
    rows = [
        (f"`{rule.name}`", rule.severity.value, rule.clause.fmi2 or "", rule.clause.fmi3 or "", rule.title)
        for rule in RULES
    ]
    return markdown_table(HEADINGS, rows, labels=5)


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.parse_args(arguments)
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), {"rules": rules()}), encoding="utf-8")


if __name__ == "__main__":
    script(main)

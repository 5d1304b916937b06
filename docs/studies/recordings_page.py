"""The tables of docs/recordings.md, between their marks."""

from pathlib import Path

from docs.studies.generated_sections import filled
from docs.studies.imports import ROOT
from driveline.harness.recordings import relations, signal_checks
from driveline.harness.recordings.plausibility import RULES
from driveline.harness.recordings.quantities import BY_UNIT, QUANTITIES, aliases
from driveline.harness.views.markdown import markdown_table

CHECKS = Path(__file__).with_name("recordings_page_checks.md").read_text(encoding="utf-8")


def make(folder: Path) -> None:
    text = (ROOT / "docs" / "recordings.md").read_text(encoding="utf-8")
    (folder / "recordings.md").write_text(page(text), encoding="utf-8")


def page(text: str) -> str:
    """The page with the tables that the declarations in `harness/recordings` make."""
    return filled(text, {"columns": _columns(), "checks": _checks(), "plausibility": _plausibility()})


def _plausibility() -> str:
    rows = ((rule.name, rule.looks_for, rule.threshold, rule.reason) for rule in RULES)
    return markdown_table(("rule", "what it looks for", "from when on", "why there"), rows, labels=4)


def _columns() -> str:
    names = aliases()
    rows = (
        (f"`{name}`", q.meaning, q.unit, q.file_unit, ", ".join(f"`{each}`" for each in names[name]) + _by_unit(name))
        for name, q in QUANTITIES.items()
    )
    return markdown_table(("quantity", "what it is", "SI", "for example in", "names"), rows, labels=5)


def _by_unit(quantity: str) -> str:
    names = ", ".join(f"`{name}`" for name in BY_UNIT.get(quantity, ()))
    return names and f"; with such a unit {names}"


def _each(
    value: str, names: tuple[str, ...] = ("T_mot", "T_ref", "omega_1", "T_load", "T_wheel", "omega_wheel")
) -> str:
    """A threshold of several quantities, those that have the same together."""
    by_value: dict[str, list[str]] = {}
    for name in names:
        by_value.setdefault(value.format(q=QUANTITIES[name]), []).append(f"`{name}`")
    return "; ".join(f"{text} ({', '.join(of)})" for text, of in by_value.items())


def _checks() -> str:
    gaps = sorted({q.gap for q in QUANTITIES.values()})
    limits = ((name, QUANTITIES[name]) for name in ("v", "elevation", "omega_1", "T_mot", "T_wheel"))
    return CHECKS.format(
        limits="; ".join(f"`{name}` {q.limit:g} {q.unit}" for name, q in limits),
        gaps=(gaps[0], gaps[-1]),
        slowest=_each("more than {q.slowest:g} s between samples"),
        least_swing=_each("{q.least_swing:g} {q.unit} or less"),
        signals=signal_checks,
        relations=relations,
    ).strip()

"""Puts the tables of docs/recordings.md between their marks: `python -m docs.studies.recordings_page`."""

from pathlib import Path

from docs.studies.generated_sections import filled
from driveline.harness.base.atomic_files import write_text
from driveline.harness.recordings import relations, signal_checks
from driveline.harness.recordings.quantities import QUANTITIES, Quantity, aliases
from driveline.harness.views.markdown import markdown_table

PATH = Path(__file__).parents[2] / "docs" / "recordings.md"


def recordings_page(text: str) -> str:
    """The page with the tables that the declarations in `harness/recordings` make."""
    return filled(text, {"columns": _columns(), "checks": _checks()})


def _columns() -> str:
    names = aliases()
    rows = (
        (f"`{name}`", q.meaning, q.unit, q.file_unit, ", ".join(f"`{alias}`" for alias in names[name]))
        for name, q in QUANTITIES.items()
    )
    return markdown_table(("quantity", "what it is", "SI", "for example in", "names"), rows, labels=5)


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
    rows = [
        ("a value that is no finite number, or larger than any car has", _limits(), "refused"),
        ("time that does not increase", "at any sample", "refused"),
        ("a gap", f"more than {gaps[0]:g} median steps, {gaps[-1]:g} between messages", "refused"),
        ("too short", f"less than {signal_checks.SHORTEST:g} s", "refused"),
        ("too slow", _each("more than {q.slowest:g} s between samples"), "refused"),
        ("constant", _each("{q.least_swing:g} {q.unit} or less"), "refused"),
        (
            "two channels exchanged",
            f"a correlation of another torque and speed is the largest, and {relations.OTHERS:g} or more",
            "refused",
        ),
        ("wrong sign of motor torque or speed", f"a correlation of -{relations.LINK:g} or less", "refused"),
        ("wrong sign of the wheel speed", "motor and wheels turn against each other", "refused"),
        (
            "wrong unit of a speed, wrong i or tyre radius",
            f"motor speed over wheel speed times i is off by more than {relations.RATIO:.0%}",
            "refused",
        ),
        (
            "wrong sign of the load",
            f"it goes with the motor torque below {relations.SLOW:g} Hz, correlation above {relations.OPPOSED:g}",
            "refused",
        ),
        (
            "wrong unit or side of a torque",
            f"the load is more than {relations.SIZE:g} times as large as the motor torque below {relations.SLOW:g} Hz, "
            f"or as small",
            "refused",
        ),
        (
            "wrong sign of the torque demand",
            f"the motor torque goes against it below {relations.SLOW:g} Hz, correlation below -{relations.OPPOSED:g}",
            "refused",
        ),
        (
            "wrong unit or side of the torque demand",
            f"it is more than {relations.SIZE:g} times as large as the motor torque below {relations.SLOW:g} Hz, "
            f"or as small",
            "refused",
        ),
        (
            "cut off (motor speed, load)",
            f"{signal_checks.CLIPPED} samples in a row at the largest or the smallest value",
            "said",
        ),
    ]
    return markdown_table(("what", "from when on", ""), rows, labels=3)


def _limits() -> str:
    def limit(q: Quantity) -> str:
        return f"{q.limit:g} {q.unit}"

    return "; ".join(
        f"`{name}` {limit(QUANTITIES[name])}" for name in ("v", "elevation", "omega_1", "T_mot", "T_wheel")
    )


if __name__ == "__main__":
    write_text(recordings_page(PATH.read_text(encoding="utf-8")), PATH)
    print(PATH)

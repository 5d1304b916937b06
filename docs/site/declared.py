"""Tables that the declarations in the code make, for the pages of the site; nobody writes them."""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

from driveline.fmus.catalogue import FMUS
from driveline.harness.identification import car_file, diagnostics, estimator, identify, noise, step, torque_loop
from driveline.harness.identification.priors import PRIORS
from driveline.harness.loop.places import CONNECTIONS, INPUTS, OPTIONAL, OUTPUTS, PARAMETERS, PLACES, ROAD_LOAD
from driveline.harness.simulation.excitation_drive import MEASURED_WHEELS
from driveline.harness.studies.faults.fault_injection import STATUS, T_DAMP
from driveline.harness.studies.faults.judges import JUDGES
from driveline.harness.views import drive_figure, run_figure, step_figure
from driveline.harness.views.markdown import markdown_table
from driveline.harness.views.signal_lines import Row
from driveline.models.controller.causes import FAILURES, FEEDING, Cause
from driveline.models.damping_controller import BLOCK
from driverecords import (
    alignment,
    channel_rules,
    force_balance,
    missing_values,
    plausibility,
    relations,
    signal_checks,
    time_base,
)
from driverecords.missing_values import FILLED
from driverecords.quantities import BY_UNIT, QUANTITIES, aliases
from driverecords.thresholds import Threshold
from fmublocks.description.documentation import tables, timing
from fmublocks.fmu import Fmu
from fmucheck.checking import RULES
from tests.shared.fmutesting.legal_hosts import HOSTS
from toolground.file_limits import LIMITS

CHECKS = Path(__file__).with_name("recording_checks.md").read_text(encoding="utf-8")


def blocks_page() -> str:
    """All blocks with their equations and variables, as Markdown."""
    return "\n".join(["# The blocks\n", *map(_block, FMUS.values())])


def _block(fmu: Fmu) -> str:
    parts = [f"## {fmu.name}", fmu.equations.strip(), timing(fmu.block)]
    for title, rows in tables(fmu.block):
        cells = [[cell.replace("|", r"\|") for cell in row] for row in rows[1:]]
        named = [[f"`{name}`", *others] for name, *others in cells]
        parts += [f"### {title}", markdown_table(rows[0], named, labels=len(rows[0]))]
    return "\n\n".join(parts) + "\n"


def causes() -> str:
    """Why the controller does not damp: the rows that it runs."""
    rows = [(str(row.number), f"`{row.word}`", row.finding, _after(row), row.heals) for row in (*FAILURES, FEEDING)]
    return markdown_table(("number", "cause", "found", "counts after", "heals by"), rows, labels=5)


def _after(row: Cause) -> str:
    return f"`{row.after}` ({getattr(BLOCK.Parameters(), row.after):g} s)" if row.after else "at once"


def check_rules() -> str:
    """What `driveline check` looks at."""
    rows = [
        (f"`{rule.name}`", rule.severity.value, rule.clause.fmi2 or "", rule.clause.fmi3 or "", rule.title, rule.others)
        for rule in RULES
    ]
    headings = ("rule", "severity", "FMI 2.0", "FMI 3.0", "what an FMU does that keeps it", "also known to")
    return markdown_table(headings, rows, labels=6)


def legal_hosts() -> str:
    """What hosts do for which a test says that they get the same numbers."""
    rows = ((row.does, "to the last bit" if "step" not in "".join(row.options) else STEPS_APART) for row in HOSTS)
    return markdown_table(("a host that", "gets the numbers of a plain one"), rows, labels=2)


STEPS_APART = "to the last bit; plants and motor within 1e-5"


def file_limits() -> str:
    """What files may take."""
    rows = ((of, f"{most:,}".replace(",", " ") + f" {unit}", reason) for of, most, unit, reason in LIMITS)
    return markdown_table(("of what", "at most", "why"), rows, labels=3)


def recording_columns() -> str:
    """What the columns of a recording may be called."""
    names = aliases()
    rows = (
        (f"`{name}`", q.meaning, q.unit, q.file_unit, ", ".join(f"`{each}`" for each in names[name]) + _by_unit(name))
        for name, q in QUANTITIES.items()
    )
    return markdown_table(("quantity", "what it is", "SI", "for example in", "names"), rows, labels=5)


def _by_unit(quantity: str) -> str:
    names = ", ".join(f"`{name}`" for name in BY_UNIT.get(quantity, ()))
    return names and f"; with such a unit {names}"


def recording_plausibility() -> str:
    """What of a recording is named as odd."""
    rows = ((rule.name, rule.looks_for, rule.threshold, rule.reason) for rule in plausibility.RULES)
    return markdown_table(("rule", "what it looks for", "from when on", "why there"), rows, labels=4)


def recording_checks() -> str:
    """What of a recording is refused."""
    gaps = sorted({q.gap for q in QUANTITIES.values()})
    limits = ((name, QUANTITIES[name]) for name in ("v", "elevation", "omega_1", "T_mot", "T_wheel"))
    return CHECKS.format(
        limits="; ".join(f"`{name}` {q.limit:g} {q.unit}" for name, q in limits),
        gaps=(gaps[0], gaps[1]),
        FILLED=FILLED,
        slowest=_each("more than {q.slowest:g} s between samples"),
        least_swing=_each("{q.least_swing:g} {q.unit} or less"),
        signals=signal_checks,
        relations=relations,
    ).strip()


def recording_thresholds() -> str:
    """The numbers that decide in them, each with the measurement that it comes from."""
    return _thresholds(
        missing_values, time_base, channel_rules, force_balance, plausibility, relations, signal_checks, alignment
    )


def identification_thresholds() -> str:
    """The numbers that decide in an identification."""
    return _thresholds(diagnostics, identify, estimator, torque_loop, noise, step, car_file)


def identification_priors() -> str:
    """What is known of the parameters before a recording is seen."""
    rows = (
        (f"`{name}`", row.meaning, row.unit, f"{row.deviation:g}" + " of ln" * row.positive, row.source)
        for name, row in PRIORS.items()
    )
    return markdown_table(("parameter", "what it is", "unit", "standard deviation", "why"), rows, labels=5)


def _thresholds(*rooms: ModuleType) -> str:
    rows: dict[int, tuple[str, ...]] = {}
    for room in rooms:
        for name, each in vars(room).items():
            if isinstance(each, Threshold) and id(each) not in rows:
                where = room.__name__.rpartition(".")[2]
                rows[id(each)] = (f"`{where}.{name}`", f"{each:g}", each.unit, each.of, each.source)
    return markdown_table(
        ("threshold", "value", "unit", "of what", "where it comes from"), list(rows.values()), labels=5
    )


def _each(value: str) -> str:
    """A threshold of several quantities, those that have the same together."""
    by_value: dict[str, list[str]] = {}
    for name in ("T_mot", "T_ref", "omega_1", "T_load", "T_wheel", "omega_wheel"):
        by_value.setdefault(value.format(q=QUANTITIES[name]), []).append(f"`{name}`")
    return "; ".join(f"{text} ({', '.join(of)})" for text, of in by_value.items())


def loop_variables() -> str:
    """What the loop exchanges with the FMU in each place; in brackets what an FMU need not have."""
    asked: dict[tuple[str, str], dict[str, str | None]] = {}
    for each in CONNECTIONS:
        asked.setdefault((each.source.partition(".")[0], "outputs"), {})[each.source] = each.unit
        asked.setdefault((each.target.partition(".")[0], "inputs"), {})[each.target] = each.unit
    for kind, ports in (("inputs", INPUTS), ("outputs", OUTPUTS), ("parameters", PARAMETERS)):
        for port in ports:
            asked.setdefault((port.name.partition(".")[0], kind), {})[port.name] = port.unit
    rows = [
        (f"`{place}`", *(_variables(asked.get((place, kind), {})) for kind in ("inputs", "outputs", "parameters")))
        for place in PLACES
    ]
    return markdown_table(("place", "inputs", "outputs", "parameters"), rows, labels=4)


def _variables(asked: dict[str, str | None]) -> str:
    needed, others = [], []
    for name, unit in asked.items():
        text = f"`{name.partition('.')[2]}`{f' {unit}' if unit else ''}"
        (others if name in OPTIONAL else needed).append(text)
    return " ".join(filter(None, (", ".join(needed), f"({', '.join(others)})" if others else "")))


def further_variables() -> str:
    """What some results use beside what the loop exchanges, and what becomes of them without it."""
    loop = {name for each in CONNECTIONS for name in (each.source, each.target)}
    loop |= {port.name for port in (*INPUTS, *OUTPUTS, *PARAMETERS)}
    uses: dict[tuple[str, str], list[str]] = {}  # by what for, and what is without it
    for module in (run_figure, step_figure, drive_figure):
        for row in vars(module).values():
            for line in row.lines if isinstance(row, Row) else ():
                for name in sorted(set(line.signal.columns) - loop):
                    uses.setdefault((f"figure, {_plain(row.label)}", "the curve is left out"), []).append(name)
    judges = ", ".join(judge.name for judge in JUDGES if judge.of_status)
    uses[f"`faults`: {judges}", "they are left out, and named"] = [STATUS]
    uses["`faults`: the torque that is added", "`T_ref` less the demand"] = [T_DAMP]
    uses["`record`: the torque of the measurement wheels", "no such column"] = [MEASURED_WHEELS]
    uses["`replay`, `record`: brake and grade", "the file of `--vehicle`"] = [f"plant.{name}" for name in ROAD_LOAD]
    rows = (
        (what, ", ".join(f"`{name}`" for name in dict.fromkeys(names)), without)
        for (what, without), names in uses.items()
    )
    return markdown_table(("result", "variables", "without them"), rows, labels=3)


def _plain(label: str) -> str:
    """The label of a panel on one line, without its unit."""
    return label.replace(",\n", ", ").replace("\n", " ").partition(" in ")[0].rstrip(",")


TABLES: dict[str, Callable[[], str]] = {
    function.__name__: function
    for function in (
        causes,
        check_rules,
        file_limits,
        legal_hosts,
        recording_columns,
        recording_plausibility,
        recording_checks,
        recording_thresholds,
        identification_thresholds,
        identification_priors,
        loop_variables,
        further_variables,
    )
}
"""By the names that pages call them."""

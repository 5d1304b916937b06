"""Checks any FMU of FMI 2.0 or 3.0: its archive, its model description (with fmpy, and what fmpy does not look at:
aliases, units, dependencies, documentation), its binary and its behaviour in co-simulation and model exchange (default
experiment, odd step sizes, reset, several instances, saved states), the latter in a process of its own.

A finding is an error (the standard demands it), a warning (it recommends it) or a note (people miss something).
Exit code 0: no errors; 1: errors, with --strict also warnings; 2: no such file.

examples:
  fmucheck model.fmu
  fmucheck --strict build/*.fmu
  fmucheck --quick --ignore archive-pages --ignore origin model.fmu
  fmucheck --format junit build/*.fmu > findings.xml
"""

import json
from argparse import ArgumentTypeError
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from fmuloop.limit_options import ForeignLimits
from toolground.arguments import option, positional, record
from toolground.plain_text import quoted
from toolground.printing import JsonPrinting

if TYPE_CHECKING:
    from .rule import Verdict

FORMATS = ("text", "json", "junit")


def _rule(text: str) -> str:
    """The name of a rule."""
    from toolground.known_names import nearest

    from .checking import RULES

    names = [rule.name for rule in RULES]
    if text not in names:
        raise ArgumentTypeError(f"there is no rule {quoted(text)}; {nearest(text, names)}")
    return text


@record
class Arguments(ForeignLimits, JsonPrinting):
    fmus: tuple[Path, ...] = positional("the FMUs to check", Path, "FILE.fmu", "+")
    strict: bool = option(False, "warnings count as errors do")
    quick: bool = option(False, "of the behaviours only the first steps of a run")
    ignore: tuple[str, ...] = option((), "leave out this rule (repeatable)", _rule, metavar="RULE")
    format: str | None = option(
        None, f"lines, one document or JUnit XML (default: {FORMATS[0]})", choices=FORMATS, exclusive=True
    )
    json: bool = option(False, "print one JSON document, as --format json", exclusive=True)


def run(args: Arguments) -> int:
    from .checking import check
    from .rule import Severity

    style = "json" if args.json else args.format or FORMATS[0]
    checks = {path: check(path, args.limits, args.quick, args.ignore) for path in args.fmus}  # all files are there
    found = {str(path): _printed(path, answers, style == "text", args.quiet) for path, answers in checks.items()}
    counts = dict.fromkeys((severity.value for severity in Severity), 0)
    for verdict in (verdict for verdicts in found.values() for verdict in verdicts):
        counts[verdict.severity] += len(verdict.problems)
    failing = {Severity.ERROR.value, *([Severity.WARNING.value] if args.strict else [])}
    _print_summary(style, found, counts, failing, args.quiet)
    return 1 if any(counts[severity] for severity in failing) else 0


def _printed(path: Path, answers: "Iterable[Verdict]", text: bool, quiet: bool) -> "list[Verdict]":
    """The verdicts on an FMU; as text each is printed as it comes, or only its problems."""
    if text and not quiet:
        print(path)
    verdicts = []
    for verdict in answers:
        verdicts.append(verdict)
        if text and quiet:
            start = f"{path}: {verdict.severity} [{verdict.rule}]"
            print("".join(f"{start}: {problem}\n" for problem in verdict.problems), end="")
        elif text:
            _print_verdict(verdict.title, verdict.problems, verdict.severity, verdict.rule, verdict.tried)
    return verdicts


MOST_PROBLEMS = 50
"""Of a rule, that are printed for people."""

SEVERITY_STYLES = {"error": "red", "warning": "yellow", "note": "cyan"}


def _print_verdict(title: str, problems: Sequence[str], severity: str, rule: str, tried: bool = True) -> None:
    """Prints a rule, whether it is kept, and the first problems on lines of their own; or that it was not tried."""
    from rich.console import Console
    from rich.text import Text

    console = Console(highlight=False, soft_wrap=True)
    if problems:
        console.print(Text(f"  {severity:8}", style=SEVERITY_STYLES[severity]) + f"not: {title} [{rule}]", markup=False)
    elif tried:
        console.print(Text("  ok      ", style="green") + title)
    else:
        console.print(f"  -       not tried: {title}", markup=False)
    for problem in problems[:MOST_PROBLEMS]:
        console.print(Text(f"        - {problem}"))
    if more := len(problems[MOST_PROBLEMS:]):
        console.print(f"        ... and {more} more; `--quiet` and `--format json` have all", markup=False)


def _print_summary(
    style: str, found: "Mapping[str, list[Verdict]]", counts: Mapping[str, int], failing: set[str], quiet: bool
) -> None:
    """Prints the numbers of findings; in the styles for tools the one document."""
    if style == "json":
        fmus = [{"fmu": name, "verdicts": [v._asdict() for v in verdicts]} for name, verdicts in found.items()]
        print(json.dumps({"findings": sum(counts.values()), **counts, "fmus": fmus}, indent=2))
    elif style == "junit":
        from .junit import junit

        print(junit(found, failing))
    elif not quiet:
        summary = ", ".join(f"{count} {name}{'s' * (count != 1)}" for name, count in counts.items() if count)
        print(f"{summary or 'no findings'} in {len(found)} FMU(s)")

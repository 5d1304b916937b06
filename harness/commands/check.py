"""Checks any FMU of FMI 2.0 or 3.0: its archive, its model description (with fmpy, and what fmpy does not look at:
aliases, units, dependencies, documentation), its binary and its behaviour in co-simulation and model exchange (default
experiment, odd step sizes, reset, several instances, saved states), the latter in a process of its own.

A finding is an error (the standard demands it), a warning (it recommends it) or a note (people miss something).
Exit code 0: no errors; 1: errors, with --strict also warnings; 2: no such file. docs/fmus.md says more.

examples:
  driveline check build/native/TwoMassDriveline.fmu
  driveline check --strict build/native/*.fmu
  driveline check --quick --ignore archive-pages --ignore origin their_car.fmu
  driveline check --format junit build/native/*.fmu > findings.xml
"""

import json
from argparse import ArgumentTypeError
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from toolground.plain_text import quoted

from .arguments import option, positional
from .options import ForeignLimits, record
from .printing import JsonPrinting

if TYPE_CHECKING:
    from fmucheck.rule import Verdict

FORMATS = ("text", "json", "junit")


def _rule(text: str) -> str:
    """The name of a rule."""
    from fmucheck.check import RULES
    from toolground.known_names import nearest

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
    from fmucheck.check import check
    from fmucheck.rule import Severity

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
    from ..views.terminal import print_verdict

    if text and not quiet:
        print(path)
    verdicts = []
    for verdict in answers:
        verdicts.append(verdict)
        if text and quiet:
            start = f"{path}: {verdict.severity} [{verdict.rule}]"
            print("".join(f"{start}: {problem}\n" for problem in verdict.problems), end="")
        elif text:
            print_verdict(verdict.title, verdict.problems, verdict.severity, verdict.rule, verdict.tried)
    return verdicts


def _print_summary(
    style: str, found: "Mapping[str, list[Verdict]]", counts: Mapping[str, int], failing: set[str], quiet: bool
) -> None:
    """Prints the numbers of findings; in the styles for tools the one document."""
    if style == "json":
        fmus = [{"fmu": name, "verdicts": [v._asdict() for v in verdicts]} for name, verdicts in found.items()]
        print(json.dumps({"findings": sum(counts.values()), **counts, "fmus": fmus}, indent=2))
    elif style == "junit":
        from fmucheck.junit import junit

        print(junit(found, failing))
    elif not quiet:
        summary = ", ".join(f"{count} {name}{'s' * (count != 1)}" for name, count in counts.items() if count)
        print(f"{summary or 'no findings'} in {len(found)} FMU(s)")

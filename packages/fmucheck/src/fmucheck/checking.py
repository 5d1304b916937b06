"""Whether an FMU keeps the standard, FMI 2.0 or 3.0, and our rules beyond it."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from fmuloop import fmu_archive
from fmuloop.description import KINDS
from fmuloop.errors import InstantiationError, SimulationError, UnpackedFolderError
from fmuloop.interface import Interface
from fmuloop.isolated_process import IsolatedProcess
from fmuloop.limits import USUAL_LIMITS, Limits
from fmuloop.unpacked_fmu import Unpacked, unpacked
from toolground.errors import UserError
from toolground.plain_text import plain

from .archive_rules import ARCHIVE_RULES, REFUSING_RULES, Archive
from .behaviour_rules import BEHAVIOUR_RULES, QUICK_RULES
from .binary_rules import BINARY_RULES, KIND, PLATFORM
from .claim_rules import CLAIM_RULES, EXCHANGE_CLAIM_RULES, STEPPING_CLAIM_RULES
from .contents_rules import CONTENTS_RULES
from .description_rules import DESCRIPTION_RULES
from .exchange_rules import EXCHANGE_RULES, QUICK_EXCHANGE_RULES
from .rule import Clause, Rule, Severity, Verdict

READABLE = Rule("readable", Severity.ERROR, "it is an FMU of FMI 2.0 or 3.0", Clause("2.2.1", "2.4.1"))

RULES = (
    *(READABLE, *REFUSING_RULES, *ARCHIVE_RULES, *DESCRIPTION_RULES, *CONTENTS_RULES),
    *(KIND, PLATFORM, *BINARY_RULES, *BEHAVIOUR_RULES, *EXCHANGE_RULES),
    *(*CLAIM_RULES, *STEPPING_CLAIM_RULES, *EXCHANGE_CLAIM_RULES),
)

FIRST = {BEHAVIOUR_RULES[0].name, EXCHANGE_RULES[0].name}
"""An FMU that ends its process there, or cannot be instantiated, is not tried any further."""


def check(
    path: Path, limits: Limits = USUAL_LIMITS, quick: bool = False, ignored: Collection[str] = ()
) -> Iterator[Verdict]:
    """Checks an FMU, one verdict after the other; one that cannot be unpacked or read is not looked at any further.

    The behaviours are tried in a process of their own; an FMU that ends it in the default experiment, or cannot be
    instantiated there, is not tried any further.

    Args:
        quick: whether only the beginning of the default experiment is tried.
        ignored: names of rules that are left out.

    Raises:
        UserError: there is no such file.
    """
    if not path.is_file():
        raise UserError(f"there is no FMU {path}")
    return _verdicts(path, limits, quick, ignored)


def _verdicts(path: Path, limits: Limits, quick: bool, ignored: Collection[str]) -> Iterator[Verdict]:
    def kept(rules: Iterable[Rule]) -> Iterator[Rule]:
        return (rule for rule in rules if rule.name not in ignored)

    try:
        contents = Archive(path, fmu_archive.entries(path), limits)
    except UserError as error:
        yield READABLE.verdict([str(error)])
        return
    refused = [rule.judge(contents) for rule in kept(REFUSING_RULES)]
    yield from refused
    if any(verdict.problems for verdict in refused):
        return
    yield from (rule.judge(contents) for rule in kept(ARCHIVE_RULES))
    try:
        interface = Interface(path, limits, list(KINDS))
    except UserError as error:
        yield READABLE.verdict([str(error)])
        return
    yield READABLE.verdict([])
    yield from (rule.judge(interface) for rule in kept((*DESCRIPTION_RULES, *CONTENTS_RULES)))
    kind = KIND.judge(interface)
    tried = [*BINARY_RULES, *_behaviours(interface, steps=not kind.problems, quick=quick)]
    platform = PLATFORM.judge(interface)
    yield from (verdict for verdict in (kind, platform) if verdict.rule not in ignored)
    if platform.problems:
        yield from (rule.verdict([], tried=False) for rule in kept(tried))
    else:
        yield from _behaviour(interface, list(kept(tried)), limits)


def _behaviours(interface: Interface, steps: bool, quick: bool) -> Iterator[Rule]:
    """The rules for an FMU of its kinds; those of what it claims come after it has run."""
    description = interface.description
    steps, exchanges = steps and description.coSimulation is not None, description.modelExchange is not None
    if steps:
        yield from QUICK_RULES if quick else BEHAVIOUR_RULES
    if exchanges:
        yield from QUICK_EXCHANGE_RULES if quick else EXCHANGE_RULES
    if not quick:
        yield from CLAIM_RULES if steps or exchanges else ()
        yield from STEPPING_CLAIM_RULES if steps else ()
        yield from EXCHANGE_CLAIM_RULES if exchanges else ()


def _behaviour(interface: Interface, rules: Sequence[Rule], limits: Limits) -> Iterator[Verdict]:
    """Tries the FMU in a process, and in another one after it has ended that."""
    isolated = None
    try:
        for tried, rule in enumerate(rules, 1):
            try:
                if isolated is None:
                    isolated = IsolatedProcess([interface.path.name] * 2, limits.call)
                    isolated.ask(_receive, interface)
                yield rule.verdict(isolated.ask(_judge, rule))
            except SimulationError as error:
                if isolated:
                    isolated.close()
                isolated = None
                # what may be the fault of our folder is not said to be that of the FMU
                excused = isinstance(error, UnpackedFolderError) and rule.name in FIRST
                yield (replace(rule, severity=Severity.NOTE) if excused else rule).verdict([str(error)])
                if rule.name in FIRST:
                    yield from (other.verdict([], tried=False) for other in rules[tried:])
                    return
    finally:
        if isolated:
            isolated.close()


# what follows runs in the other process

_fmu: Unpacked
_files = ExitStack()


def _receive(interface: Interface) -> None:
    """Unpacks it, once for all that is tried; the files vanish with those of the process."""
    global _fmu
    _fmu = _files.enter_context(unpacked(interface))


def _judge(rule: Rule) -> list[str]:
    try:
        return rule.judge(_fmu).problems
    except InstantiationError:
        raise
    except Exception as error:  # nobody foresees what an FMU makes of a rule
        return [f"cannot be tried: {type(error).__name__}: {plain(error)}"]

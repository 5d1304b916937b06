"""A rule of `driveline check`, and what became of it."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Enum
from typing import Any, NamedTuple

from fmuloop.errors import InstantiationError
from toolground.errors import UserError
from toolground.plain_text import plain


class Severity(Enum):
    """What the standard says of it: it must be so, it should be so, or nothing, but people miss something."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


class Clause(NamedTuple):
    """Where the standard asks for it: sections of FMI 2.0.4 and of FMI 3.0.2; None: it does not."""

    fmi2: str | None = None
    fmi3: str | None = None

    def __str__(self) -> str:
        asking = (("FMI 2.0.4", self.fmi2), ("FMI 3.0.2", self.fmi3))
        return "; ".join(f"{standard}, {sections}" for standard, sections in asking if sections)


OURS = Clause()
"""Of a rule that no standard has."""


class Verdict(NamedTuple):
    """What a rule found: nothing, if the FMU keeps it.

    Attributes:
        rule: its name.
        severity: the value of its Severity.
        tried: whether it was; if not, it has found nothing.
        clause: of the standard; empty if the rule is ours.
    """

    rule: str
    severity: str
    title: str
    problems: list[str]
    tried: bool = True
    clause: str = ""


Problems = Callable[..., Iterable[str]]
"""Lists what breaks a rule; it is given what the rule is about."""


@dataclass(frozen=True)
class Rule:
    """A rule.

    Attributes:
        name: by which it can be ignored.
        title: what an FMU does that keeps it.
        clause: of the standard.
        others: checkers that know it too, of fmpy, FMUChecker and VDMCheck.
        problems: lists what breaks it; nothing for a rule that is judged elsewhere.
    """

    name: str
    severity: Severity
    title: str
    clause: Clause = OURS
    problems: Problems = lambda *_: ()
    others: str = ""

    def judge(self, *subject: Any) -> Verdict:
        """What breaks it; one thing may be that the FMU cannot be read or refuses a call.

        Raises:
            InstantiationError: so that nothing can be said of a rule.
        """
        problems: list[str] = []
        try:
            problems.extend(map(plain, self.problems(*subject)))
        except InstantiationError:
            raise
        except UserError as error:
            problems.append(plain(error))
        return self.verdict(problems)

    def verdict(self, problems: list[str], tried: bool = True) -> Verdict:
        return Verdict(self.name, self.severity.value, self.title, problems, tried, str(self.clause))


class Rules(list[Rule]):
    """Rules for one subject, in the order in which they stand there."""

    def rule(
        self, name: str, severity: Severity, title: str, clause: Clause = OURS, others: str = ""
    ) -> Callable[[Problems], Problems]:
        """What lists the problems of a rule becomes one of these."""

        def enter(problems: Problems) -> Problems:
            self.append(Rule(name, severity, title, clause, problems, others))
            return problems

        return enter

"""A rule of `driveline check`, and what became of it."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Enum
from typing import Any, NamedTuple

from ...base.errors import DrivelineError
from ...base.plain_text import plain


class Severity(Enum):
    """How bad it is to break a rule: hosts fail, tools complain, or people miss something."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


class Verdict(NamedTuple):
    """What a rule found: nothing, if the FMU keeps it.

    Attributes:
        rule: its name.
        severity: the value of its Severity.
        tried: whether it was; if not, it has found nothing.
    """

    rule: str
    severity: str
    title: str
    problems: list[str]
    tried: bool = True


Problems = Callable[..., Iterable[str]]
"""Lists what breaks a rule; it is given what the rule is about."""


@dataclass(frozen=True)
class Rule:
    """A rule.

    Attributes:
        name: by which it can be ignored.
        title: what an FMU does that keeps it.
        problems: lists what breaks it; nothing for a rule that is judged elsewhere.
    """

    name: str
    severity: Severity
    title: str
    problems: Problems = lambda *_: ()

    def judge(self, *subject: Any) -> Verdict:
        """What breaks it; one thing may be that the FMU cannot be read or refuses a call."""
        found: list[str] = []
        try:
            found.extend(map(plain, self.problems(*subject)))
        except DrivelineError as error:
            found.append(plain(error))
        return self.verdict(found)

    def verdict(self, problems: list[str], tried: bool = True) -> Verdict:
        return Verdict(self.name, self.severity.value, self.title, problems, tried)


class Rules(list[Rule]):
    """Rules for one subject, in the order in which they stand there."""

    def rule(self, name: str, severity: Severity, title: str) -> Callable[[Problems], Problems]:
        """What lists the problems of a rule becomes one of these."""

        def enter(problems: Problems) -> Problems:
            self.append(Rule(name, severity, title, problems))
            return problems

        return enter

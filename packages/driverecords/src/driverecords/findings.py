"""What is looked for in recordings, and what is found."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from typing import Any, NamedTuple

import numpy as np

from .channels import Channel
from .source import RecordingError

LOG = logging.getLogger(__name__)

MOST_MARKED = 200
"""Samples of a finding that a figure marks."""


class Rule(NamedTuple):
    """What is odd.

    Attributes:
        name: for tables and tools.
        looks_for: in words.
        threshold: from when on it is found.
        reason: where the threshold comes from: physics, or what was measured.
    """

    name: str
    looks_for: str
    threshold: str
    reason: str


@dataclass(frozen=True)
class Finding:
    """What is odd in a recording.

    Attributes:
        column: its heading.
        time: of the recording, in s.
        odd: what, to stand after column and time.
        place: in the file, as in "line 12"; empty where no single one is meant.
        samples: times in s of all samples that are odd so, or MOST_MARKED of them.
    """

    rule: Rule
    column: str
    time: float
    odd: str
    place: str = ""
    samples: tuple[float, ...] = ()

    def __str__(self) -> str:
        return f"{self.place}{self.place and ': '}{self.column} at {self.time:.6g} s {self.odd}"

    def document(self) -> dict[str, Any]:
        """For tools."""
        return {"rule": self.rule.name, "column": self.column, "time_s": self.time, "text": str(self)}


def at_samples(channel: Channel, rule: Rule, at: np.ndarray, odd: str) -> Finding:
    """A finding at samples of a channel, by their indices, of which the first is named."""
    first, times = int(at[0]), marked(channel.time[at])
    return Finding(rule, channel.heading, float(channel.time[first]), odd, channel.where(first), times)


def marked(times: np.ndarray) -> tuple[float, ...]:
    """Those of the times that a figure marks."""
    few = np.linspace(0, len(times) - 1, min(len(times), MOST_MARKED)).round().astype(int)
    return tuple(times[few].tolist())


def more(count: int, what: str = "sample") -> str:
    """How many there are, if it is more than the one that is named."""
    return "" if count == 1 else f" ({count} {what}s)"


def tell(findings: Sequence[Finding], recording: PathLike[str] | str, strict: bool = False) -> None:
    """Logs what is odd in a recording, a warning each.

    Raises:
        RecordingError: something is, and it is strict.
    """
    for finding in findings:
        LOG.warning("%s: %s", recording, finding)
    if findings and strict:
        names = ", ".join(dict.fromkeys(finding.rule.name for finding in findings))
        raise RecordingError(f"{recording} is not plausible ({names}), which --strict refuses")

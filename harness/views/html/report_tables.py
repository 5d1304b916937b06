"""Tables of a report, whose headings say what they mean."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ...metrics.declaration import Column, Metric


class Heading(NamedTuple):
    """Of a column of words, or of numbers, which stand to the right; with what it means."""

    text: str
    meaning: str = ""
    number: bool = False


class Row(NamedTuple):
    """Cells, and what the figures show when the row is clicked, if anything."""

    cells: Sequence[str]
    choice: str = ""
    muted: bool = False


@dataclass(frozen=True)
class Table:
    headings: Sequence[Heading]
    rows: Sequence[Row]
    notes: Sequence[str] = ()

    @property
    def explained(self) -> list[Heading]:
        """The headings that have a meaning."""
        return [heading for heading in self.headings if heading.meaning]


def of_metrics(shown: Iterable[tuple[Metric, Column]]) -> Iterator[Heading]:
    """The headings of metrics as the tables show them."""
    for metric, column in shown:
        yield Heading(f"{column.plain_heading}, {column.unit}", f"{metric.description} ({metric.key} in files)", True)

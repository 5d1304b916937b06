"""The runs of a campaign on file, so that one that was stopped goes on."""

import csv
from collections.abc import Iterator, Sequence
from math import nan
from pathlib import Path

from ...base.csv_file import write_rows
from ...base.errors import DrivelineError
from .outcome import METRICS, Case, Outcome

COLUMNS = [*Case._fields, *(metric.key for metric in METRICS), "reason"]


class Archive(dict[Case, Outcome]):
    """The outcomes by their cases. A run is on file as soon as it is added, with all digits.

    Args:
        path: of the CSV file, which may be absent, and whose last line may be torn.

    Raises:
        DrivelineError: the file is not one of a campaign.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._path = path
        if path.is_file():
            self.update((outcome.case, outcome) for outcome in _read(path))

    def begin(self) -> None:
        """Makes the file whole."""
        self.write(list(self.values()))

    def add(self, outcome: Outcome) -> None:
        self[outcome.case] = outcome
        with self._path.open("a", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerow(_row(outcome))

    def write(self, outcomes: Sequence[Outcome]) -> None:
        """Writes these runs, in this order."""
        write_rows(COLUMNS, map(_row, outcomes), self._path)


def _row(outcome: Outcome) -> list[object]:
    values = (outcome.measured[metric.name] for metric in METRICS)
    return [*outcome.case, *("" if value != value else repr(value) for value in values), outcome.reason]


def _read(path: Path) -> Iterator[Outcome]:
    text = path.read_text(encoding="utf-8", errors="replace")
    whole = text[: text.rfind("\n") + 1]  # a process that was killed may have left a part of a line
    rows = list(csv.reader(whole.splitlines()))
    if not rows or rows[0] != COLUMNS:
        raise DrivelineError(f"{path}: its first line must be {','.join(COLUMNS)}")
    for number, row in enumerate(rows[1:], 2):
        try:
            plant, controller, drawn, manoeuvre, *values, reason = row
            measured = {m.name: float(v) if v else nan for m, v in zip(METRICS, values, strict=True)}
            yield Outcome(Case(plant, controller, int(drawn), manoeuvre), measured, reason)
        except ValueError as error:
            raise DrivelineError(f"{path}, line {number}: it must have the columns of the first line") from error

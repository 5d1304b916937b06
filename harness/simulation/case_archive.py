"""The answers of a campaign by its cases, on file as soon as they are known: one that was stopped goes on.

```python
with resumable(path, table, record, settings, systems, inputs) as made:
    outcomes = run_many(function, cases, known=made.archive)
    made.files += [...]
```
"""

import csv
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from io import StringIO
from pathlib import Path
from typing import Any, Generic, TypeVar

from fmuloop.wiring import Fit
from toolground.atomic_files import alone, naming, remove
from toolground.csv_file import write_rows
from toolground.errors import UserError

from .code_behind import digest_behind
from .provenance import content, require_files, require_same_run, write_record

Case = TypeVar("Case", bound=Hashable)
Answer = TypeVar("Answer")

PACKAGES = ("driveline-damping", "numpy", "scipy")
"""On whose versions the last digits of an answer depend."""

GOES_ON = "the same command goes on where it was stopped"


@dataclass(frozen=True)
class Table(Generic[Case, Answer]):
    """How a file has cases and answers, one pair a line.

    Attributes:
        columns: their names.
        cells: of a case and its answer, with all digits.
        parsed: case and answer that have these cells.
        needed: what a line must have, in words; `parsed` raises a ValueError for one that has it not.
    """

    columns: Sequence[str]
    cells: Callable[[Case, Answer], Sequence[object]]
    parsed: Callable[[Sequence[str]], tuple[Case, Answer]]
    needed: str = "the columns of the first line"


class CaseArchive(dict[Case, Answer]):
    """Answers by cases, in a CSV file. What is added is on file at once.

    Args:
        path: of the file, which may be absent, or end in a torn line, which is forgotten; it is made whole.
        table: what its lines are.

    Raises:
        UserError: the file is not such a table.
    """

    def __init__(self, path: Path, table: Table[Case, Answer]) -> None:
        super().__init__()
        self._path = path
        self._table = table
        if path.is_file():
            self.update(self._read())
        self._write()

    def __setitem__(self, case: Case, answer: Answer) -> None:
        super().__setitem__(case, answer)
        with naming(self._path), self._path.open("a", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerow(self._table.cells(case, answer))

    def sort(self, key: Callable[[Case], Any]) -> None:
        """Orders the lines by their cases."""
        answers = {case: self[case] for case in sorted(self, key=key)}
        self.clear()
        self.update(answers)
        self._write()

    def _write(self) -> None:
        write_rows(self._table.columns, (self._table.cells(*each) for each in self.items()), self._path)

    def _read(self) -> Iterator[tuple[Case, Answer]]:
        text = self._path.read_bytes().decode("utf-8", errors="replace")
        whole = text[: text.rfind("\n") + 1]  # a process that was killed may have left a part of a line
        columns = [*self._table.columns]
        rows = _rows(whole)
        if next(rows, None) != columns:
            raise UserError(f"{self._path}: its first line must be {','.join(columns)}")
        for number, row in enumerate(rows, 2):
            try:
                if len(row) != len(columns):
                    raise ValueError
                yield self._table.parsed(row)
            except ValueError as error:
                raise UserError(f"{self._path}, line {number}: it must have {self._table.needed}") from error


def _rows(text: str) -> Iterator[list[str]]:
    """The cells of each line; at one that is no CSV they end with an empty row."""
    try:
        yield from csv.reader(StringIO(text, newline=""))
    except csv.Error:
        yield []


@dataclass
class Campaign(Generic[Case, Answer]):
    """A campaign that is run.

    Attributes:
        archive: what is known of its cases.
        files: that it has written.
        provenance: what makes the files, see `harness.simulation.provenance.content`.
    """

    archive: CaseArchive[Case, Answer]
    files: list[Path]
    provenance: Mapping[str, Any]


@contextmanager
def resumable(
    path: Path,
    table: Table[Case, Answer],
    record: Path,
    run: Mapping[str, Any],
    fits: Mapping[str, Fit],
    inputs: Sequence[Path | None],
    results: Sequence[Path] = (),
    replace: bool = False,
) -> Iterator[Campaign[Case, Answer]]:
    """Within it a campaign is run and written, or one that was stopped goes on, while no other writes to its folder.

    Args:
        path: of the archive.
        table: what its lines are; it belongs to the module that computes them, whose code distinguishes the campaign.
        record: the JSON file beside it that tells what makes the files.
        run: all that distinguishes the campaign, but for the versions of PACKAGES.
        fits: the systems that run, by their names.
        inputs: files beside the FMUs that it reads.
        results: other files that it will write, as far as their names are known.
        replace: whether results of another campaign may be replaced.

    Raises:
        UserError: there are results of another campaign, or a folder in the place of one; nothing has been run.
    """
    code = digest_behind(table.parsed.__module__)
    run = {**run, "code": code, "versions": {name: version(name) for name in PACKAGES}}
    require_files([path, *results, record])
    with alone(record.parent):
        try:
            require_same_run(record, run, [path, *results])
        except UserError:
            if not replace:
                raise
            remove(path)
        write_record(record, run, fits, [path], inputs)
        made = Campaign(CaseArchive(path, table), [path], content(run, fits, [], inputs))
        try:
            yield made
        except KeyboardInterrupt as stop:
            stop.add_note(GOES_ON)
            raise
        write_record(record, run, fits, made.files, inputs)

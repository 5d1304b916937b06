"""The candidates of a search on file, so that one that was stopped goes on."""

import csv
from collections.abc import Iterator, MutableMapping, Sequence
from io import StringIO
from math import isfinite
from pathlib import Path

from ...base.atomic_files import write_text
from ...base.errors import DrivelineError
from .controller_cost import Costs
from .parameter_search import Values


class Archive(MutableMapping[Values, Costs]):
    """Costs by candidates. The file is complete after each that is added, with all digits.

    Args:
        path: of the CSV file, which may be absent.
        names: of the searched parameters.

    Raises:
        DrivelineError: the file is not one of such a search.
    """

    def __init__(self, path: Path, names: Sequence[str]) -> None:
        self._path = path
        self._columns = [*names, *Costs._fields]
        self._rows = dict(_read(path, self._columns)) if path.is_file() else {}

    def __getitem__(self, values: Values) -> Costs:
        return self._rows[values]

    def __setitem__(self, values: Values, costs: Costs) -> None:
        self._rows[values] = costs
        text = StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self._columns)
        writer.writerows([*map(repr, (*key, *row))] for key, row in self._rows.items())
        write_text(text.getvalue(), self._path)

    def __delitem__(self, values: Values) -> None:
        raise TypeError("what is known is not forgotten")

    def __iter__(self) -> Iterator[Values]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)


def _read(path: Path, columns: Sequence[str]) -> Iterator[tuple[Values, Costs]]:
    rows = list(csv.reader(path.read_text(encoding="utf-8", errors="replace").splitlines()))
    if not rows or rows[0] != columns:
        raise DrivelineError(f"{path}: its first line must be {','.join(columns)}")
    for number, row in enumerate(rows[1:], 2):
        try:
            numbers = [float(cell) for cell in row]
        except ValueError:
            numbers = []
        if len(numbers) != len(columns) or not all(map(isfinite, numbers)):
            raise DrivelineError(f"{path}, line {number}: it must have {len(columns)} finite numbers")
        size = len(Costs._fields)
        yield tuple(numbers[:-size]), Costs(*numbers[-size:])

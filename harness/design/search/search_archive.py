"""How a search is on file: what its candidates cost."""

from collections.abc import Sequence
from math import isfinite

from ...simulation.case_archive import Table
from .controller_cost import Costs
from .parameter_search import Values


def table(names: Sequence[str]) -> Table[Values, Costs]:
    """Of a search for the parameters of these names."""
    columns = [*names, *Costs._fields]

    def parsed(cells: Sequence[str]) -> tuple[Values, Costs]:
        numbers = [float(cell) for cell in cells]
        if not all(map(isfinite, numbers)):
            raise ValueError
        return tuple(numbers[: len(names)]), Costs(*numbers[len(names) :])

    return Table(columns, lambda values, costs: [*values, *costs], parsed, f"{len(columns)} finite numbers")

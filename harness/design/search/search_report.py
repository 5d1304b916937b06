"""What a search found, as a table."""

from collections.abc import Sequence

from rich.box import SIMPLE_HEAD
from rich.table import Table

from .parameter_search import Evaluated, best
from .search_space import Space

COSTS = ("cost", "swing", "comfort", "response")


def choices_table(visited: Sequence[Evaluated], space: Space, characters: Sequence[float]) -> Table:
    """The start and the choices for these characters: what they cost, and their parameters."""
    table = Table(title="costs over those of the computed gains", title_justify="left", box=SIMPLE_HEAD, padding=0)
    for heading in ("character", *COSTS, *(each.name for each in space.searched)):
        table.add_column(heading, justify="right", min_width=8)
    _row(table, "start", 0.5, visited[0])
    for character in characters:
        _row(table, f"{character:g}", character, best(visited, character))
    return table


def _row(table: Table, name: str, character: float, each: Evaluated) -> None:
    costs = (f"{cost:.3f}" for cost in (each.costs.total(character), *each.costs))
    table.add_row(name, *costs, *(f"{value:.4g}" for value in each.values))

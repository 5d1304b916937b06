"""What a search found, as a figure, comfort against response, and as a table of what the driver may choose."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.table import Table

from ...views.colours import BLACK, BLUE, GREEN, GREY, VERMILION
from ...views.figure_style import plot
from ...views.panels import DASH_DOT, DASHED, DOTTED, SOLID, Axis, Curve, Drawing, Panel, Points
from .controller_cost import Costs
from .parameter_search import Evaluated, best, front
from .search_space import Space

CHOICES = np.linspace(0.0, 1.0, 41)
COLOURS, DASHES = (VERMILION, GREEN, BLUE, BLACK), (SOLID, DASHED, DOTTED, DASH_DOT)
"""Of the choices that are marked, and of the curves of the parameters."""

MARGIN = 0.25
"""What the axes show beyond what is marked, on each side, over its extent."""


def front_drawing(visited: Sequence[Evaluated], space: Space, marked: Mapping[str, float], title: str) -> Drawing:
    """The candidates of a search with their front, comfort against response, and the parameters from sport to comfort.

    Args:
        marked: characters by their names, COLOURS of them at the most.
    """
    chosen = {name: best(visited, character).costs for name, character in marked.items()}
    start = visited[0].costs
    comfort, response = _at([*chosen.values(), start])
    costs = [
        Points(*_at(candidate.costs for candidate in visited), "candidates", GREY, 2.0),
        Curve(*_at(candidate.costs for candidate in front(visited)), "front", BLACK, width=0.8, held=True),
        *(Points(*_at([of]), name, color, 7.0) for (name, of), color in zip(chosen.items(), COLOURS, strict=False)),
        Points(*_at([start]), "start", BLACK, 7.0, "square"),
    ]
    along = [best(visited, choice).values for choice in CHOICES]
    shares = [
        Curve(
            CHOICES,
            np.array([values[k] / parameter.start for values in along]),
            parameter.name,
            COLOURS[k % len(COLOURS)],
            DASHES[k // len(COLOURS) % len(DASHES)],
            held=True,
        )
        for k, parameter in enumerate(space.searched)
    ]
    left = Axis("comfort: overshoot and jerk", _around(comfort))
    right = Axis("character, from sport to comfort", (0.0, 1.0))
    rows = [
        [Panel("response: 90 % time\nand torque withheld", costs, bounds=_around(response), x=left)],
        [Panel("parameter over its start", shares, columns=4, x=right)],
    ]
    return Drawing(rows, right, f"{title}: {len(visited)} candidates", size=(7.2, 2.8), same_y=False)


def plot_front(visited: Sequence[Evaluated], space: Space, character: float, title: str, stem: Path) -> list[Path]:
    """Draws them; the choice is marked beside both ends. Returns the files written.

    Args:
        stem: path of the files without their ending.
    """
    marked = {"sport": 0.0, f"character {character:g}": character, "comfort": 1.0}
    drawn = front_drawing(visited, space, marked, f"{title}, costs over those of the computed gains")
    return plot(drawn.rows, drawn.x, drawn.title, stem, size=drawn.size, same_y=drawn.same_y)


def _at(costs: Iterable[Costs]) -> tuple[np.ndarray, np.ndarray]:
    listed = list(costs)
    return np.array([of.comfort for of in listed]), np.array([of.response for of in listed])


def _around(values: np.ndarray) -> tuple[float, float]:
    margin = max(MARGIN * float(np.ptp(values)), 0.02)
    return float(values.min()) - margin, float(values.max()) + margin


COSTS = ("cost", "swing", "comfort", "response")


def choices_table(visited: Sequence[Evaluated], space: Space, characters: Sequence[float]) -> Table:
    """The start and the choices for these characters: what they cost, and their parameters."""
    table = Table(title="costs over those of the computed gains", title_justify="left", box=SIMPLE_HEAD, padding=0)
    for heading in ("character", *COSTS, *(parameter.name for parameter in space.searched)):
        table.add_column(heading, justify="right", min_width=8)
    _row(table, "start", 0.5, visited[0])
    for character in characters:
        _row(table, f"{character:g}", character, best(visited, character))
    return table


def _row(table: Table, name: str, character: float, candidate: Evaluated) -> None:
    costs = (f"{cost:.3f}" for cost in (candidate.costs.total(character), *candidate.costs))
    table.add_row(name, *costs, *(f"{value:.4g}" for value in candidate.values))

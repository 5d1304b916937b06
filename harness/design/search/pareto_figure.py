"""What a search found, as a figure, comfort against response, and as a table of what the driver may choose."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.ticker import FuncFormatter, NullFormatter
from rich.box import SIMPLE_HEAD
from rich.table import Table

from ...views.colours import BLACK, BLUE, GREY, PURPLE, VERMILION
from ...views.figure_style import sheet
from .parameter_search import Evaluated, best, front
from .search_space import Space

COLORS_OF_LINES, DASHES = 6, ("-", "--", ":")
"""Lines of different parameters."""

CHOICES = np.linspace(0.0, 1.0, 41)
COLORS = LinearSegmentedColormap.from_list("character", (VERMILION, PURPLE, BLUE))
MARGIN = 0.25
"""What the axes show beyond the choices, on each side, over their extent."""


def plot_front(visited: Sequence[Evaluated], space: Space, character: float, title: str, stem: Path) -> list[Path]:
    """Draws the candidates of a search with their front, and the choices from sport to comfort.

    Args:
        character: the choice that is marked.
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    with sheet((8.0, 3.2), title, stem, pads=(0.04, 0.08)) as (figure, files):
        left, right = figure.subplots(1, 2, width_ratios=(1.1, 1.0))
        _costs(left, visited, character)
        _parameters(right, visited, space, character)
    return files


def _costs(axes: Axes, visited: Sequence[Evaluated], character: float) -> None:
    """Comfort against response: all candidates, the front, the start and the choices."""
    chosen = [best(visited, choice).costs for choice in CHOICES]
    comfort, response = (np.array([getattr(c, group) for c in chosen]) for group in ("comfort", "response"))
    edge, start, marked = front(visited), visited[0].costs, best(visited, character).costs
    axes.plot([e.costs.comfort for e in visited], [e.costs.response for e in visited], ".", color=GREY, ms=2.5)
    axes.step([e.costs.comfort for e in edge], [e.costs.response for e in edge], where="post", color=BLACK, lw=0.8)
    axes.scatter(comfort, response, c=CHOICES, cmap=COLORS, s=16, zorder=3)
    axes.plot(start.comfort, start.response, "x", color=BLACK, ms=7, mew=1.5, zorder=4)
    axes.plot(marked.comfort, marked.response, "o", mfc="none", mec=BLACK, ms=9, zorder=4)
    beside = {"xytext": (-5, -4), "textcoords": "offset points", "ha": "right", "va": "top"}  # there are no candidates
    for text, k in (("sport", 0), ("comfort", -1)):
        axes.annotate(text, (comfort[k], response[k]), color=COLORS(CHOICES[k]), **beside)
    axes.annotate("start", (start.comfort, start.response), **beside)
    axes.set(
        xlabel="comfort: overshoot and jerk, over those\nof the computed gains",
        ylabel="response: 90 % time and withheld torque",
        xlim=_around([*comfort, start.comfort]),
        ylim=_around([*response, start.response]),
    )


def _around(values: Sequence[float]) -> tuple[float, float]:
    margin = max(MARGIN * (max(values) - min(values)), 0.02)
    return min(values) - margin, max(values) + margin


def _parameters(axes: Axes, visited: Sequence[Evaluated], space: Space, character: float) -> None:
    """The searched parameters over their start, against the character."""
    chosen = [best(visited, choice).values for choice in CHOICES]
    for k, each in enumerate(space.searched):
        share = [values[k] / each.start for values in chosen]
        color, dashes = f"C{k % COLORS_OF_LINES}", DASHES[k // COLORS_OF_LINES % len(DASHES)]
        axes.plot(CHOICES, share, color=color, ls=dashes, drawstyle="steps-mid", label=_symbol(each.name))
    axes.axvline(character, color=BLACK, lw=0.6, ls="--")
    axes.set(
        yscale="log", xlim=(0.0, 1.0), xlabel="character, from sport to comfort", ylabel="parameter over its start"
    )
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    low, high = axes.get_ylim()
    numbers = FuncFormatter(lambda value, _: f"{value:g}") if high < 10.0 * low else NullFormatter()
    axes.yaxis.set_minor_formatter(numbers)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, handlelength=1.5)


def _symbol(name: str) -> str:
    """A parameter as in a formula: omega_w is $\\omega_{w}$; a word stays a word."""
    letter, _, index = name.partition("_")
    if letter == "omega":
        letter = "\\omega"
    elif len(letter) > 1:
        return name
    return f"${letter}_{{{index}}}$" if index else f"${letter}$"


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

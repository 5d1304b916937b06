"""The documentation page that `driveline robustness` writes."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from ...design.uncertainty_box import BOX, DOUBLINGS, LOSS, SCALED, SHORTEST, SPREAD
from ...manoeuvres.catalogue import MANOEUVRES as CATALOGUE
from ...views.markdown import markdown_table
from .draws import draw
from .outcome import MANOEUVRES, SHOWN, VERDICTS
from .summary import Summary, cells, goal

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")
PLANT = Path(__file__).with_name("robustness_page_plant.md").read_text(encoding="utf-8")


def page(summaries: Sequence[Summary], seed: int, arguments: str, drawn: Sequence[Summary]) -> str:
    """The page as Markdown.

    Args:
        arguments: of the command, beside how many cases.
        drawn: those of which there is a figure of the worst draw.
    """
    count, controller = len(summaries[0].outcomes), summaries[0].controller
    plants = list(dict.fromkeys(summary.plant for summary in summaries))
    own = [summary for summary in summaries if summary.controller == controller]
    return PAGE.format(
        arguments=arguments,
        cases=count,
        runs=count * len(summaries),
        manoeuvres="\n".join(f"- `{name}`: {CATALOGUE[name].description}" for name in MANOEUVRES),
        box=markdown_table(["what", "least", "most", "spread evenly"], _box(), labels=1),
        spread=1e3 * SPREAD,
        shortest=1e3 * SHORTEST,
        loss=100.0 * LOSS,
        scaled="\n".join(f"- {name}: {', '.join(f'`{each}`' for each in names)}" for name, names in SCALED.items()),
        verdicts="\n".join(f"- *{name}*: {meaning}." for name, meaning in VERDICTS.items()),
        three=min(300.0 / count, 100.0),
        results="\n\n".join(_of_plant(plant, summaries, controller) for plant in plants),
        controller=controller,
        worst=markdown_table(["plant", "manoeuvre", "draw"], _worst(own, seed), labels=3),
        figures="\n".join(f"![{s.plant}, {s.manoeuvre}](figures/{figure_name(s)}.png)" for s in drawn),
    )


def figure_name(summary: Summary) -> str:
    """Of the figure of the worst draw of a summary."""
    return f"worst_{summary.plant}_{summary.manoeuvre}"


def _box() -> Iterator[list[str]]:
    units = {"delay": "s", "o_T": "N.m"}
    for name, (low, high) in BOX.items():
        unit = f" in {units[name]}" if name in units else ""
        yield [f"`{name}`{unit}", f"{low:g}", f"{high:g}", "by factors" if name in DOUBLINGS else "by differences"]


def _of_plant(plant: str, summaries: Sequence[Summary], controller: str) -> str:
    its = [summary for summary in summaries if summary.plant == plant]
    metrics = (f"{column.plain_heading}, {column.unit}" for column in SHOWN.values())
    headings = ["controller", "bounded and quiet, %", "good, %", *metrics]
    tables = [
        f"{name}:\n\n"
        + markdown_table(headings, ([s.controller, *cells(s)] for s in its if s.manoeuvre == name), labels=1)
        for name in dict.fromkeys(summary.manoeuvre for summary in its)
    ]
    return PLANT.format(
        plant=plant, tables="\n\n".join(tables), controller=controller, goal=goal(its, plant, controller)
    ).strip()


def _worst(own: Sequence[Summary], seed: int) -> Iterator[list[str]]:
    for summary in own:
        yield [summary.plant, summary.manoeuvre, str(draw(summary.worst.case.number, seed))]

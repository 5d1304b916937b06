"""The documentation page that `driveline robustness` writes."""

from collections.abc import Iterator, Sequence

from ...design.uncertainty_box import BOX, DOUBLINGS, LOSS, SCALED, SHORTEST, SPREAD
from ...manoeuvres.catalogue import MANOEUVRES as CATALOGUE
from ...views.markdown import markdown_table
from .draws import draw
from .outcome import MANOEUVRES, SHOWN, VERDICTS
from .summary import Summary, cells, goal

PAGE = """\
# Robustness

{cases} cars with their sensors are drawn. Each is driven with every controller, through

{manoeuvres}

which makes {runs} runs. No controller is told anything of the draw. Draw and noise follow from the seed and the number
of a draw alone, so they are the same for every controller, both plants and any number of cores.

This runs one of the draws again and draws it:

    driveline robustness --case NUMBER{arguments}

## What is drawn

{box}

A message of the wheel speed takes from {spread:g} ms less to {spread:g} ms more than the drawn delay (or less, where
that is less), and never less than {shortest:g} ms; {loss:g} % of the messages are lost. In the blocks that have it, a
factor multiplies

{scaled}

## When a run is bounded and quiet, and when it is good

{verdicts}

The specification leaves these words open; they are defined in `harness/studies/robustness/outcome.py`.

Where no run of {cases} fails, the true share of failures is below {three:.2g} % with a confidence of 95 %.

{results}

## The worst draws of the {controller}

Those that settle last.

{worst}

{figures}

## More cores

The cases run on all cores. The same command goes on where it was stopped: `runs.csv` has each run as soon as it has
been made, `robustness.json` says what made them. With more `--cases` it keeps those that it has. On a Dask cluster
(`pip install 'driveline-damping[cluster]'`) they run with

    dask scheduler                                   # says its address
    dask worker tcp://ADDRESS:8786                   # on every machine
    driveline robustness --scheduler tcp://ADDRESS:8786

and nothing else changed. Every worker needs this package and the FMUs at the same path, as on a shared disk; an FMU
with another content is refused. What a worker has answered is fetched at once. When one is lost, what it had not
answered is run again by another one.

Made by `driveline robustness --cases {cases}{arguments}`; do not edit.
"""


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
    return (
        f"## {plant}\n\nOf each metric: what half / 95 % of the runs do not exceed in magnitude; a dash where "
        f"more runs have no value, as a torque that never settles.\n\n"
        + "\n\n".join(tables)
        + f"\n\nBounded and quiet; 95 % of the settling time of tip-in / launch ({controller}): "
        f"{goal(its, plant, controller)}\n\n![distributions](figures/robustness_{plant}.png)"
    )


def _worst(own: Sequence[Summary], seed: int) -> Iterator[list[str]]:
    for summary in own:
        yield [summary.plant, summary.manoeuvre, str(draw(summary.worst.case.number, seed))]

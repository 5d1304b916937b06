"""The documentation page that `python -m docs.studies coupling` writes."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from ...cosimulation.schedule import Transfer
from ...cosimulation.system import Scheme
from ...views.markdown import markdown_table
from .coupling import SIGNALS, Comparison
from .step_dependence import STEPS, Case

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")


def page(
    comparisons: Sequence[Comparison],
    dead_times: Mapping[tuple[Scheme, float], Mapping[str, float]],
    transfers: Mapping[str, Transfer],
    order: Sequence[str],
    step_size: float,
    metrics: Mapping[Case, Mapping[str, float]],
) -> str:
    """The page as Markdown.

    Args:
        comparisons: each with a deviation at `step_size` (s).
        dead_times: by scheme and communication step, then by section of the loop, in s.
        transfers: of inputs under the propagated scheme.
        order: of the instances.
        metrics: deviations of the metrics by case, see `.step_dependence`.
    """
    moving = {t: _names(name for name in transfers if transfers[name] is t) or "none here" for t in Transfer}
    return PAGE.format(
        interpolated=moving[Transfer.INTERPOLATED],
        extrapolated=moving[Transfer.EXTRAPOLATED],
        order=_names(order),
        step=1e3 * step_size,
        duration=comparisons[0].manoeuvre.duration,
        dead_times=_dead_times(dead_times),
        errors=_errors(comparisons, step_size),
        orders=_orders(comparisons),
        coarse=1e3 * STEPS[0],
        fine=1e3 * STEPS[1],
        metrics=_metrics(metrics),
    )


def _names(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _dead_times(found: Mapping[tuple[Scheme, float], Mapping[str, float]]) -> str:
    columns = list(found.values())
    heads = [f"{scheme.value}, h = {1e3 * step:g} ms" for scheme, step in found]
    # adding zero turns a rounded -0 into 0
    rows = [[name, *(f"{round(1e3 * column[name], 2) + 0.0:.2f}" for column in columns)] for name in columns[0]]
    return markdown_table(["connection", *heads], rows, labels=1)


def _errors(comparisons: Sequence[Comparison], step_size: float) -> str:
    rows = [
        [
            *_case(c),
            *(f"{_percent(d.largest)} / {_percent(d.rms)}" for d in c.deviations[step_size].values()),
        ]
        for c in comparisons
    ]
    return markdown_table([*CASE, *(f"`{name}`" for name in SIGNALS)], rows, labels=3)


def _orders(comparisons: Sequence[Comparison]) -> str:
    steps = list(comparisons[0].deviations)
    rows = [
        [
            *_case(c),
            *(_percent(c.deviations[step]["plant.T_gear"].rms) for step in steps),
            f"{c.order('plant.T_gear'):.1f}",
        ]
        for c in comparisons
    ]
    return markdown_table([*CASE, *(f"{1e3 * step:g}" for step in steps), "order"], rows, labels=3)


def _metrics(found: Mapping[Case, Mapping[str, float]]) -> str:
    runs = dict.fromkeys((case.plant, case.manoeuvre) for case in found)
    rows = [[*run, *(_worst(found[Case(*run, control)]) for control in (False, True))] for run in runs]
    return markdown_table(["plant", "manoeuvre", "without damping", "with damping"], rows, labels=2)


def _worst(deviations: Mapping[str, float]) -> str:
    name = max(deviations, key=deviations.__getitem__)
    return f"{_percent(deviations[name])} ({name.replace('_', ' ')})"


CASE = ("plant", "tip-in", "scheme")


def _case(c: Comparison) -> tuple[str, str, str]:
    return c.plant, c.manoeuvre.description, c.scheme.value


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g}"

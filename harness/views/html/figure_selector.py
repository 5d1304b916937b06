"""A control by which the figures show one of many things whose data are all in the page."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

from .linked_figures import Columns, source_of
from .report_page import CHOICE

if TYPE_CHECKING:
    from bokeh.models import ColumnDataSource, Range1d, Select

SHOW = """
shown.forEach((source, k) => { source.data = choices[this.value][k].data })
const [start, end] = windows[this.value] ?? []
x_range?.setv({start, end, reset_start: start, reset_end: end})
"""


def chosen(
    title: str,
    choices: Mapping[str, Sequence[Columns]],
    windows: Mapping[str, tuple[float, float]] = MappingProxyType({}),
    x_range: "Range1d | None" = None,
    name: str = CHOICE,
) -> "tuple[Select, list[ColumnDataSource]]":
    """The control, and the sources of the figures, which show the first of the choices.

    Args:
        choices: the tables of each source, by the names of the choices.
        windows: what of the abscissa each choice shows at first.
        x_range: of the abscissa; None: all choices show the same of it.
    """
    from bokeh.models import CustomJS, Select

    sources = {choice: [source_of(columns) for columns in each] for choice, each in choices.items()}
    first = next(iter(choices))
    shown = [source_of(columns) for columns in choices[first]]
    control = Select(title=title, value=first, options=list(choices), name=name, width=420)
    given = {"shown": shown, "choices": sources, "windows": dict(windows), "x_range": x_range}
    control.js_on_change("value", CustomJS(args=given, code=SHOW))
    return control, shown

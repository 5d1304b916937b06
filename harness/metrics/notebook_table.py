"""Metrics as tables in a notebook: HTML for one run, a data frame for many."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from math import isnan
from typing import TYPE_CHECKING, Any

from toolground.errors import UserError

from .declaration import Metric, declared

if TYPE_CHECKING:
    from pandas import DataFrame


class NotebookTable:
    """A record of metrics with a table for notebooks: SI units, the meaning of each as a tooltip."""

    def _repr_html_(self) -> str:
        rows = "".join(_row(metric, self) for metric in declared(type(self)))
        return f"<table><thead><tr><th>metric</th><th>value</th><th>unit</th></tr></thead><tbody>{rows}</tbody></table>"


def _row(metric: Metric, record: Any) -> str:
    value = metric.of(record)
    number = f"<td>{value:.4g}</td>"
    if isnan(value):
        number = f'<td title="{escape(record.absent.get(metric.name, "no value"))}">-</td>'
    unit = "" if metric.unit == "1" else escape(metric.unit)
    return f'<tr title="{escape(metric.description)}"><td>{metric.name}</td>{number}<td>{unit}</td></tr>'


def frame(runs: Mapping[Any, Any]) -> DataFrame:
    """The metrics of several runs, a row each; NaN where one has no value, `attrs["units"]` has the units.

    Args:
        runs: records of metrics of one kind by what is to stand before the rows; tuples become an index of several
            levels, those with named fields one with these names.

    Raises:
        UserError: there are no runs.
    """
    from pandas import DataFrame, Index  # only who asks for it waits for its import

    if not runs:
        raise UserError("there are no runs; a frame of metrics needs one or more")
    labels, records = list(runs), list(runs.values())
    every = declared(type(records[0]))
    index = Index(labels)
    if fields := getattr(labels[0], "_fields", None):
        index.names = fields
    found = DataFrame({metric.name: [metric.of(record) for record in records] for metric in every}, index=index)
    found.attrs["units"] = {metric.name: metric.unit for metric in every}
    return found

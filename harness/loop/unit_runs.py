"""A run of a loop of several drive units, as one of them sees it."""

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from fmuloop.results import Results

from .topology import BODY, DriveUnit


def of_unit(results: Results, unit: DriveUnit) -> Results:
    """A run with the signals of a drive unit under the names of their roles, without the blocks of the others."""
    if unit == DriveUnit():
        return results
    fields: Any = results.dtype.fields or {}
    renamed = {f"{BODY}.{role}": f"{BODY}.{own}" for role, own in unit.of_plant if f"{BODY}.{own}" in fields}
    others = (name for name in fields if name not in renamed.values())
    columns = {"time": "time"} | {role: own for role in _roles(others, unit) if (own := unit.own(role)) in fields}
    columns |= renamed
    layout: Any = {
        "names": list(columns),
        "formats": [fields[own][0] for own in columns.values()],
        "offsets": [fields[own][1] for own in columns.values()],
        "itemsize": results.dtype.itemsize,
    }
    seen: Any = results.view(np.dtype(layout))
    seen.units = {role: results.units[own] for role, own in columns.items() if own in results.units}
    return seen


def _roles(columns: Iterable[str], unit: DriveUnit) -> Iterator[str]:
    """What columns of these instances are called in a loop of one drive unit, but for the unit's own of the plant."""
    for name in columns:
        place = name.partition(".")[0].removesuffix(f"_{unit.name}")
        if name.startswith(f"{unit.instance(place)}."):
            yield f"{place}.{name.partition('.')[2]}"

"""The numbers of a study in its file: tables, the thinned arrays of its figures, and what they were measured with."""

import json
import platform
import subprocess
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from driveline.harness.views import panels
from driveline.harness.views.panels import Drawing
from toolground.atomic_files import write_text

from .study import Column, Measured, Table

ROOT = Path(__file__).parents[2]
DATA = Path(__file__).parent / "data"

DIGITS = 6
"""Of a number in a table."""

POINTS, POINT_DIGITS = 250, 5
"""Of a curve in a figure, each as its least and largest value there; and the digits of a number in it."""

PACKAGES = ("driveline-damping", "numpy", "scipy")


class Kept(NamedTuple):
    """What a file has.

    Attributes:
        commit: at which it was measured; with a + there were changes that were not committed.
        date: of the measurement.
        cpu_seconds: that it took.
    """

    commit: str
    date: str
    versions: Mapping[str, str]
    cpu_seconds: float
    measured: Measured

    @property
    def origin(self) -> str:
        """In words."""
        return f"measured at {self.commit} on {self.date}"


def file_of(name: str) -> Path:
    """The file of a study."""
    return DATA / f"{name}.json"


def read(name: str) -> Kept:
    """The numbers of a study.

    Raises:
        FileNotFoundError: it has not been measured yet.
    """
    content = json.loads(file_of(name).read_text(encoding="utf-8"))
    tables = {
        key: Table(of["label"], tuple(Column(*fields) for fields in of["columns"]), _rows(of["rows"]), of["note"])
        for key, of in content["tables"].items()
    }
    figures = {key: _decoded(of) for key, of in content["figures"].items()}
    measured = Measured(tables, figures)
    return Kept(content["commit"], content["date"], content["versions"], content["cpu_seconds"], measured)


def write(name: str, measured: Measured, seeds: Sequence[int], cpu_seconds: float) -> None:
    """Keeps the numbers of a study, measured just now."""
    versions = {"python": platform.python_version(), **{package: version(package) for package in PACKAGES}}
    kept = {
        "commit": _commit(),
        "date": datetime.now(UTC).date().isoformat(),
        "versions": versions,
        "seeds": list(seeds),
        "cpu_seconds": float(f"{cpu_seconds:.3g}"),
        "tables": {
            key: {
                "label": table.label,
                "note": table.note,
                "columns": table.columns,
                "rows": {row: [_short(cell, DIGITS) for cell in cells] for row, cells in table.rows.items()},
            }
            for key, table in measured.tables.items()
        },
        "figures": {key: _encoded(_seen(drawing)) for key, drawing in measured.figures.items()},
    }
    DATA.mkdir(exist_ok=True)
    write_text(_text(kept) + "\n", file_of(name))


def _text(value: Any, depth: int = 0) -> str:
    """JSON with a line for each row of a table: what has changed is seen in a diff."""
    if isinstance(value, Mapping) and value and depth < 4:
        indent = "\n" + " " * (depth + 1)
        lines = (f"{indent}{json.dumps(key)}: {_text(item, depth + 1)}" for key, item in value.items())
        return f"{{{','.join(lines)}\n{' ' * depth}}}"
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def _rows(rows: Mapping[str, Sequence[Any]]) -> dict[str, tuple[Any, ...]]:
    return {row: tuple(cells) for row, cells in rows.items()}


def _commit() -> str:
    """The commit of the checkout; a + where product or study has been changed since."""
    told = (
        subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
        for words in (
            ["rev-parse", "--short=9", "HEAD"],
            ["status", "--porcelain", "--untracked-files=no", "--", ":(glob)**/*.py", "fmus", "models", "harness"],
        )
    )
    head, changed = told
    return head + "+" * bool(changed)


def _short(value: Any, digits: int) -> Any:
    """A number in so many digits."""
    if isinstance(value, float | np.floating):
        return float(f"{value:.{digits}g}") if np.isfinite(value) else None
    return int(value) if isinstance(value, np.integer) else value


def thinned(part: Any) -> Any:
    """A curve or band with no more points than a figure shows."""
    if not isinstance(part, panels.Curve | panels.Band) or len(part.x) <= 2 * POINTS:
        return part
    first = range(0, len(part.x), -(-len(part.x) // POINTS))
    if isinstance(part, panels.Band):
        return part._replace(
            x=part.x[first], low=np.fmin.reduceat(part.low, first), high=np.fmax.reduceat(part.high, first)
        )
    ends = [*first[1:], len(part.x)]
    rows = [k for pair in zip(first, ends, strict=True) for k in _extremes(part.y, *pair)]
    return part._replace(x=part.x[rows], y=part.y[rows])


def _extremes(y: np.ndarray, begin: int, end: int) -> list[int]:
    """Where a piece is least and largest, in their order."""
    piece = y[begin:end]
    if np.isnan(piece).all():
        return [begin]
    return sorted({begin + int(np.nanargmin(piece)), begin + int(np.nanargmax(piece))})


def _seen(drawing: Drawing) -> Drawing:
    """The figure less what is outside of its windows."""
    rows = [[panels.within([panel], *(panel.x or drawing.x).window)[0] for panel in row] for row in drawing.rows]
    return drawing._replace(rows=rows)


def _encoded(value: Any) -> Any:
    match value:
        case Drawing() | panels.Panel() | panels.Axis():
            fields = value._asdict() if isinstance(value, tuple) else vars(value)
            return {"is": type(value).__name__, **{name: _encoded(field) for name, field in fields.items()}}
        case tuple() if hasattr(value, "_fields"):
            fields = thinned(value)._asdict()
            return {"is": type(value).__name__, **{name: _encoded(field) for name, field in fields.items()}}
        case np.ndarray():
            return [_short(number, POINT_DIGITS) for number in value.astype(float).tolist()]
        case Mapping():
            return [[_encoded(key), _encoded(item)] for key, item in value.items()]
        case list() | tuple():
            return [_encoded(item) for item in value]
    return _short(value, POINT_DIGITS)


def _decoded(value: Any) -> Any:
    if isinstance(value, list):
        return tuple(_decoded(item) for item in value)
    if not isinstance(value, dict):
        return value
    kind = getattr(panels, value["is"])
    fields = {name: _decoded(item) for name, item in value.items() if name != "is"}
    for name in getattr(kind, "ARRAYS", ()):
        fields[name] = np.array([np.nan if number is None else number for number in fields[name]], dtype=float)
    if kind is panels.Panel:
        fields["ticks"] = dict(fields["ticks"])
    return kind(**fields)

"""Declaring the metrics: unit, meaning and place in the tables, each in one place, as the blocks declare theirs.

    settling_time: Annotated[float, Metric("s", "time until ...", Column("settling", "ms", 1e3, 0))]

Help, tables, legends, CSV and JSON read from here with `declared` what they say of a metric.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import isfinite, nan
from typing import Any, NamedTuple, get_type_hints

from toolground.plain_text import printed


class Absent(ValueError):
    """A metric makes no sense for a run; the text says why."""


class Column(NamedTuple):
    """How a table shows a metric: heading (in lines), unit, factor from the SI unit and decimals."""

    heading: str
    unit: str
    factor: float
    decimals: int

    @property
    def plain_heading(self) -> str:
        """The heading on one line."""
        return self.heading.replace("-\n", "").replace("\n", " ")

    @property
    def printed_unit(self) -> str:
        """The unit as it is printed; nothing where there is none."""
        return "" if self.unit == "1" else printed(self.unit)

    @property
    def titled(self) -> str:
        """Heading and unit on one line."""
        return ", ".join(filter(None, (self.plain_heading, self.printed_unit)))


@dataclass(frozen=True)
class Metric:
    """A metric with its SI unit (Modelica notation, "1" for none) and its meaning; without column, no table has it.

    Its name is that of the field that it declares.
    """

    unit: str
    description: str
    column: Column | None = None
    name: str = ""

    @property
    def key(self) -> str:
        """Name and unit in words, for files: impact_speed in rad/s is impact_speed_rad_per_s."""
        return f"{self.name}_{self.unit.replace('.', '_').replace('/', '_per_')}"

    def of(self, record: Any) -> float:
        """Its value in a record."""
        return getattr(record, self.name)


def declared(record: type) -> tuple[Metric, ...]:
    """The metrics of a record, in the order of its fields."""
    hints = get_type_hints(record, include_extras=True)
    return tuple(
        replace(hint.__metadata__[0], name=name) for name, hint in hints.items() if hasattr(hint, "__metadata__")
    )


def measured(computed: Mapping[str, Callable[[], float]], none_because: str | None = None) -> dict[str, Any]:
    """The fields of a record of metrics: their values, and in `absent` why those that are NaN have none.

    Args:
        computed: metrics by name; one that raises Absent or is not finite has no value.
        none_because: why none has one.
    """
    values, absent = dict.fromkeys(computed, nan), {}
    for name, compute in computed.items():
        try:
            if none_because:
                raise Absent(none_because)
            value = compute()
            if not isfinite(value):
                raise Absent(f"computed as {value}")
            values[name] = value
        except Absent as reason:
            absent[name] = str(reason)
    return {**values, "absent": absent}


def given(record: Any, name: str) -> float:
    """A metric of a record.

    Raises:
        Absent: it has no value.
    """
    if name in record.absent:
        raise Absent(record.absent[name])
    return getattr(record, name)

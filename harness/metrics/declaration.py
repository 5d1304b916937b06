"""Declaring the metrics: unit, meaning and place in the tables, each in one place, as the blocks declare theirs.

    settling_time: Annotated[float, Metric("s", "time until ...", Column("settling", "ms", 1e3, 0))]

Help, tables, legends, CSV and JSON read from here with `declared` what they say of a metric.
"""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple, get_type_hints


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
    return tuple(replace(hint.__metadata__[0], name=name) for name, hint in hints.items())

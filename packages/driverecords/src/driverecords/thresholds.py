"""Thresholds as rows: number, unit, what it bounds, and the measurement that it comes from."""

from typing import Self


class Threshold(float):
    """A number that decides.

    Attributes:
        unit: as in Modelica.
        of: what it bounds.
        source: the measurement, or the physics, that it comes from.
    """

    unit: str
    of: str
    source: str

    def __new__(cls, value: float, unit: str, of: str, source: str) -> Self:
        threshold = super().__new__(cls, value)
        threshold.unit, threshold.of, threshold.source = unit, of, source
        return threshold

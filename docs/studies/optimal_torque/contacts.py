"""Which flanks of the teeth touch, and when: once this is given, the design model is linear."""

from typing import NamedTuple

GAP = 0
"""Side of the teeth between the flanks; 1 is that of a twist above phi_B, -1 below -phi_B."""

PARTS = 4
"""Parts of a sample: the grid of switching times is 0.5 ms wide."""


class Contacts(NamedTuple):
    """Sides that the teeth are on, one after the other.

    Attributes:
        sides: of each stretch.
        ends: of all stretches but the last, in parts of a sample from the first one that control can change.
    """

    sides: tuple[int, ...]
    ends: tuple[int, ...] = ()

    def side(self, part: int) -> int:
        """In a part, counted as the ends are."""
        return self.sides[sum(part >= end for end in self.ends)]

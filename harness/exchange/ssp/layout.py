"""The picture of a loop, laid out from its connections: x to the right and y up, as the standard has it.

A block stands to the right of those that feed it, inputs on the left and outputs on the right of each. A line to the
next column bends in the gap between both, one over more columns runs above all blocks, and one back below them.
"""

from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

from fmuloop.system import Connection

WIDTH, GAP, PITCH = 150.0, 130.0, 22.0
"""Of a box, between columns, and between connectors and lines that run side by side."""


class Box(NamedTuple):
    """A rectangle by its lower left and upper right corners."""

    x1: float
    y1: float
    x2: float
    y2: float


class Place(NamedTuple):
    """Of a connector on its box, from 0, 0 at the lower left to 1, 1 at the upper right."""

    x: float
    y: float


class Layout:
    """Where blocks and connectors stand, and how the lines run.

    Attributes:
        boxes: of the instances.
        places: of the connectors `instance.variable`.
        corners: of the line of a connection, from its source on.
    """

    def __init__(self, instances: Sequence[str], connections: Sequence[Connection]) -> None:
        columns = _columns(instances, connections)
        sides = [dict.fromkeys(c.target for c in connections), dict.fromkeys(c.source for c in connections)]
        self.boxes: dict[str, Box] = {}
        self.places: dict[str, Place] = {}
        tallest = defaultdict[int, float](float)
        for instance in instances:
            own = [[name for name in side if _block(name) == instance] for side in sides]
            column, height = columns[instance], PITCH * (1 + max(2, *map(len, own)))
            left, top = column * (WIDTH + GAP), -tallest[column]
            self.boxes[instance] = Box(left, top - height, left + WIDTH, top)
            tallest[column] += height + 2.0 * PITCH
            for x, names in enumerate(own):
                for k, name in enumerate(names, 1):
                    self.places[name] = Place(float(x), 1.0 - k / (len(names) + 1))
        self.corners = self._corners(connections, columns)

    def point(self, name: str) -> tuple[float, float]:
        """Of a connector."""
        box, place = self.boxes[_block(name)], self.places[name]
        return box.x1 + place.x * (box.x2 - box.x1), box.y1 + place.y * (box.y2 - box.y1)

    def _corners(
        self, connections: Sequence[Connection], columns: dict[str, int]
    ) -> dict[tuple[str, str], list[tuple[float, float]]]:
        ends = [(c.source, c.target, columns[_block(c.source)], columns[_block(c.target)]) for c in connections]
        lanes = defaultdict[int, list[tuple[str, str, int]]](list)
        for source, target, begin, end in ends:
            lanes[begin].append((source, target, 0))
            if end != begin + 1:
                lanes[end - 1].append((source, target, 1))
        x = {
            line: gap * (WIDTH + GAP) + WIDTH + GAP * k / (len(lines) + 1)
            for gap, lines in lanes.items()
            for k, line in enumerate(lines, 1)
        }
        above, below = 0.0, min(box.y1 for box in self.boxes.values())
        corners = {}
        for source, target, begin, end in ends:
            (_, y_source), (_, y_target) = self.point(source), self.point(target)
            first = x[source, target, 0]
            if end == begin + 1:
                corners[source, target] = [(first, y_source), (first, y_target)]
                continue
            above, below = (above + PITCH, below) if end > begin else (above, below - PITCH)
            y, last = above if end > begin else below, x[source, target, 1]
            corners[source, target] = [(first, y_source), (first, y), (last, y), (last, y_target)]
        return corners


def _columns(instances: Sequence[str], connections: Sequence[Connection]) -> dict[str, int]:
    """The column of each block: as many connections away as it is from those that the first signal of all reaches, the
    controllers; what nothing reaches stands before these."""
    edges = {(_block(c.source), _block(c.target)) for c in connections}
    reached = {_block(c.target) for c in connections if c.source == connections[0].source}
    columns, column = dict.fromkeys(instances, 0), 0
    waiting = [instance for instance in instances if instance not in reached]
    while reached:
        column += 1
        columns |= dict.fromkeys(reached, column)
        reached = {fed for fed in waiting if any((of, fed) in edges for of in reached)}
        waiting = [instance for instance in waiting if instance not in reached]
    return columns


def _block(name: str) -> str:
    return name.partition(".")[0]

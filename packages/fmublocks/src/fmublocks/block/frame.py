"""Declaring the frames that a block sends or takes over a bus, from which a database of the bus (DBC) is made.

What a content carries is one of the quantities of the block, so that its meaning stands there; what depends on the
parameters is a function of them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from .declaration import Record
from .operators import clip, floor

MOST_BITS = 32
"""Of a whole number on the bus."""


def unity(p: Record) -> float:
    return 1.0


@dataclass(frozen=True)
class Content:
    """A signal of a frame.

    Attributes:
        name: on the bus.
        quantity: of the Output or the Input of the block.
        unit: on the bus; "" for none.
        bits: of an unsigned whole number, as many as it has at least; of a counter that begins again, exactly.
        resolution: p -> value on the bus of one count; None: it is a number of single precision.
        factor: p -> what a value of the quantity is multiplied by to be in that unit.
        largest: p -> value on the bus; None: what the bits hold.
        meaning: of the value on the bus; "": that of the quantity.
    """

    name: str
    quantity: str
    unit: str
    bits: int
    resolution: Callable[[Any], float] | None = unity
    factor: Callable[[Any], float] = unity
    largest: Callable[[Any], float] | None = None
    meaning: str = ""


@dataclass(frozen=True)
class Frame:
    """A frame on the bus.

    Attributes:
        identifier: of 11 bits.
        sender, receiver: the units on the bus.
        cycle: p -> time in s from one to the next.
        contents: one behind the other, the first bit of the first byte first.
        counter: quantity that is one more with every frame; "": they are sent at every cycle.
    """

    identifier: int
    name: str
    meaning: str
    sender: str
    receiver: str
    cycle: Callable[[Any], float]
    contents: tuple[Content, ...]
    counter: str = ""


class Layout(NamedTuple):
    """What the bits of a content are, for a car.

    Attributes:
        resolution: value on the bus of one count; None: single precision.
        bits: that it has.
        largest: value on the bus; None: what single precision holds.
    """

    resolution: float | None
    bits: int
    largest: float | None


def layout(content: Content, p: Record) -> Layout:
    """
    Raises:
        ValueError: the bits do not hold the largest value in its resolution.
    """
    if content.resolution is None:
        return Layout(None, content.bits, None)
    resolution = content.resolution(p)
    largest = content.largest(p) if content.largest else resolution * (2**content.bits - 1)
    counts = largest / resolution if resolution > 0.0 else 2.0**MOST_BITS
    bits = max(content.bits, int(counts + 0.5).bit_length())
    if bits > MOST_BITS:
        raise ValueError(
            f"{content.name} in steps of {resolution:g} {content.unit}: {MOST_BITS} bits do not hold "
            f"{largest:g} {content.unit} in such steps; its resolution must be larger"
        )
    return Layout(resolution, bits, largest)


def count(content: Content, of: Layout, value: float, p: Record) -> float:
    """What the bits of a content hold that is a whole number, for a value of its quantity."""
    assert of.resolution is not None
    whole = 2.0**of.bits
    if content.largest is None:
        return value - whole * floor(value / whole)
    return clip(floor(value * content.factor(p) / of.resolution + 0.5), 0.0, whole - 1.0)

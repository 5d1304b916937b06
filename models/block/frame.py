"""Declaring the frames that a block sends or takes over a bus, from which a database of the bus (DBC) is made.

What a content carries is one of the quantities of the block, so that its meaning stands there; what depends on the
parameters is a function of them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from .declaration import Record


def one(p: Record) -> float:
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
    resolution: Callable[[Any], float] | None = one
    factor: Callable[[Any], float] = one
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

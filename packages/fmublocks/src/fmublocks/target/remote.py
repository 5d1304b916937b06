"""A controller whose functions run on the emulated target; part of the FMU that has the image in it.

The state stays on the target as long as it is the one that is asked for. Another one, as after a restore, is sent
there first, so that the functions are pure, as those of every block.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any
from weakref import finalize

from ..block.declaration import is_tuple
from .link import Link, emulated

KNOWN = 4
"""States of which the outputs are kept; a runner asks for those of the last one or two."""


class Remote:
    """The functions of a sampled block, computed by an image on the emulated target, which starts when it is needed."""

    def __init__(self, block: Any, image: Path) -> None:
        self._block, self._image = block, image
        self._link: Link | None = None
        self._p: Any = None
        self._known: deque[tuple[Any, tuple[float, ...]]] = deque(maxlen=KNOWN)
        self._held: Any = None

    @property
    def block(self) -> Any:
        """The block with these functions."""
        return replace(self._block, start=self.start, update=self.update, output=self.output)

    def start(self, u: Any, p: Any) -> Any:
        return self._new(self._ready(p).start(numbers(u)), self._block.start(u, p))

    def update(self, x: Any, u: Any, p: Any) -> Any:
        link = self._ready(p)
        if x is not self._held:
            link.set_state(numbers(x))
        return self._new(link.update(numbers(u)), x)

    def output(self, x: Any, u: Any, p: Any) -> Any:
        link = self._ready(p)
        for state, outputs in self._known:
            if state is x:
                return self._block.Output._make(outputs)
        answer = link.set_state(numbers(x))
        self._held = x
        self._known.append((x, answer.outputs))
        return self._block.Output._make(answer.outputs)

    def close(self) -> None:
        """Ends the emulator, if it runs."""
        if self._link:
            self._link.close()

    def _ready(self, p: Any) -> Link:
        """The link to the target, which has these parameters."""
        if self._link is None:
            self._link = Link(emulated(self._image), f"{self._block.name} on the emulated target")
        if p != self._p:
            self._link.set_parameters(numbers(p))
            self._p = p
            self._known.clear()
        return self._link

    def _new(self, answer: Any, template: Any) -> Any:
        """The state that has come, as a record like another."""
        self._held = like(template, answer.state)
        self._known.append((self._held, answer.outputs))
        return self._held


class OnTarget:
    """Mixed into a slave whose package has the image `image` in it: every instance has a target of its own."""

    image: Path
    block: Any

    def __init__(self, **kwargs: Any) -> None:
        remote = Remote(type(self).block, self.image)
        self.block = remote.block
        self._remote = remote
        finalize(self, remote.close)
        super().__init__(**kwargs)


def numbers(record: Any) -> list[float]:
    """The numbers in nested tuples, in their order."""
    return [n for item in record for n in numbers(item)] if is_tuple(record) else [float(record)]


def like(record: Any, values: Sequence[float]) -> Any:
    """A record of the shape and the types of another with these numbers."""
    numbers = iter(values)

    def alike(item: Any) -> Any:
        if not is_tuple(item):
            return type(item)(next(numbers))
        return getattr(type(item), "_make", tuple)([alike(inner) for inner in item])

    return alike(record)

"""One FMU: which block it runs, and how it starts."""

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Self

from .block.types import Block, with_start_values


@dataclass(frozen=True)
class Fmu:
    """One FMU: a block, and what an FMU shows of it beside.

    Attributes:
        block: what it runs.
        stop_time, step_size: in s, of the experiment that a tool proposes.
        start_values: of the parameters whose start values are not those that the block was declared with.
        image: program of the target that runs the functions of the block; none: they run here.
        about: attributes of the model description: version, author, copyright, license.
        sources: folder of all that makes its equations; None: not known, so that it is always built anew.
    """

    block: Block
    stop_time: float
    step_size: float = 0.001
    start_values: Mapping[str, Any] = field(default_factory=dict[str, Any])
    image: bytes = b""
    about: Mapping[str, str] = field(default_factory=dict[str, str])
    sources: Path | None = None

    @property
    def name(self) -> str:
        return self.block.name

    @property
    def module(self) -> str:
        """Module that holds the equations."""
        return self.block.module

    @property
    def equations(self) -> str:
        """Docstring of that module."""
        return sys.modules[self.block.module].__doc__ or ""

    def started_with(self, values: Mapping[str, Any]) -> Self:
        """The FMU with those of the start values, by name, whose parameters it has."""
        own = {name: values[name] for name in self.block.Parameters._fields if name in values}
        block = with_start_values(self.block, own) if own else self.block
        return replace(self, block=block, start_values={**self.start_values, **own})

"""What an FMU shows of a block."""

import sys
from dataclasses import dataclass

from models.block.types import Block


@dataclass(frozen=True)
class Fmu:
    """One FMU.

    Attributes:
        block: what it runs.
        stop_time, step_size: in s, of the experiment that a tool proposes.
    """

    block: Block
    stop_time: float
    step_size: float = 0.001

    @property
    def name(self) -> str:
        return self.block.name

    @property
    def module(self) -> str:
        """Module that holds the equations, for example models.two_mass_driveline."""
        return self.block.module

    @property
    def equations(self) -> str:
        """Docstring of that module."""
        return sys.modules[self.module].__doc__ or ""

"""What a run is asked for: how long, in which steps, under which scheme, with which signals and parameters."""

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import floor, inf, isfinite

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolground.progress import chunks

from .errors import WiringError
from .system import Scheme

Source = ArrayLike | Callable[[NDArray[np.float64]], ArrayLike]
"""An input from outside: a constant, a sample for each instant, or a function of instants, which is asked for some at a
time in a long run."""


@dataclass(frozen=True, eq=False)
class Experiment:
    """A run of FMUs from the start on.

    Attributes:
        duration: in s; the run ends with the last whole step.
        step_size: communication step in s.
        inputs: `instance.variable` -> signal, held over each communication step.
        parameters: `instance.variable` -> value; `instance.variable@t` -> value from the time t in s on.
        scheme: when outputs reach inputs.
        tolerance: relative, of FMUs that integrate; None: that of each FMU's default experiment.
        label: of the progress display.
    """

    duration: float
    step_size: float = 1e-3
    inputs: Mapping[str, Source] = field(default_factory=dict[str, Source])
    parameters: Mapping[str, float] = field(default_factory=dict[str, float])
    scheme: Scheme = Scheme.PROPAGATED
    tolerance: float | None = None
    label: str = "simulating"

    def time(self) -> NDArray[np.float64]:
        """Its instants, see `instants`."""
        return instants(self.duration, self.step_size)

    def samples(self, time: NDArray[np.float64]) -> dict[str, NDArray[np.generic]]:
        """Those of its inputs at the instants, see `sampled`."""
        return {name: sampled(name, source, time) for name, source in self.inputs.items()}


MOST_STEPS = 2**53
"""From here on a double does not tell the number of a step from that of the next."""

AT_ONCE = 2**18
"""Instants at which an input is evaluated at a time."""

BYTES_OF_A_ROW = 50.0
"""About what an instant of the loop takes in memory; its row is in a file where there are many."""


def memory() -> float:
    """Bytes that the machine has, inf if it does not say."""
    names = getattr(os, "sysconf_names", {})
    if "SC_PHYS_PAGES" not in names or "SC_PAGE_SIZE" not in names:
        return inf
    return float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")


def require_steps(duration: float, step_size: float) -> None:
    """Refuses a run whose steps cannot be made.

    Args:
        duration, step_size: in s.

    Raises:
        WiringError: there is not one step to make, or there are too many to count.
        MemoryError: they are more than the machine has memory for; nothing has been allocated.
    """
    if not (isfinite(duration) and isfinite(step_size) and 0.0 < step_size <= duration):
        raise WiringError(
            f"a step of {step_size:g} s in a run of {duration:g} s: steps must be longer than 0 s and "
            "not longer than the run"
        )
    if not duration / step_size < MOST_STEPS:
        raise WiringError(f"a step of {step_size:g} s in a run of {duration:g} s: these are too many steps")
    needed = duration / step_size * BYTES_OF_A_ROW
    if needed > memory():
        raise MemoryError(
            f"a step of {step_size:g} s in a run of {duration:g} s needs about {needed / 1e9:.3g} GB; "
            f"there are {memory() / 1e9:.3g}"
        )


def instants(duration: float, step_size: float) -> NDArray[np.float64]:
    """k * step_size for k = 0, 1, ... up to the duration, in s.

    Raises:
        WiringError, MemoryError: as of `require_steps`.
    """
    require_steps(duration, step_size)
    # never added up: FMUs refused sums of floats as an "Invalid currentCommunicationPoint"
    return np.arange(floor(duration / step_size + 1e-6) + 1, dtype=np.float64) * step_size


def sampled(name: str, source: Source, time: NDArray[np.float64]) -> NDArray[np.generic]:
    """The samples of an input at the instants, or the one value that it has at all of them.

    Raises:
        WiringError: there are more or fewer samples than instants.
    """
    samples = _evaluated(source, time) if callable(source) else np.asarray(source)
    if samples.shape not in ((), time.shape):
        raise WiringError(f"{name} has {samples.shape} samples; the run has {len(time)} instants")
    return samples


def _evaluated(source: Callable[[NDArray[np.float64]], ArrayLike], time: NDArray[np.float64]) -> NDArray[np.generic]:
    """What a function gives for the instants."""
    if len(time) <= AT_ONCE:
        return np.asarray(source(time))
    samples = np.concatenate(
        [
            np.broadcast_to(np.asarray(source(time[rows.start : rows.stop])), len(rows))
            for rows in chunks(len(time), AT_ONCE)
        ]
    )
    return samples[0] if (samples == samples[0]).all() else samples

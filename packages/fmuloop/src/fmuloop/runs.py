"""Runs of systems that are loaded for one run, or once for many."""

from collections.abc import Hashable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from threading import local

from toolground.interruption import unswallowed

from .errors import SimulationError
from .experiment import Experiment
from .fmu_archive import version
from .loading import IsolatedLoop, loaded
from .master import Loop
from .results import Results
from .system import System
from .wiring import Fit

MOST_KEPT = 8
"""Systems that are kept loaded at a time."""


def run(system: System | Fit, experiment: Experiment) -> Results:
    """Loads a system of FMUs, unless it is kept loaded, and runs it; results as of `Loop.run`.

    Args:
        system: or what is known of it already.

    Raises:
        WiringError: the FMUs do not fit together, or do not fit the inputs and parameters.
        SimulationError: an FMU cannot be loaded, or refused a call.
    """
    names = experiment.inputs, experiment.parameters
    with unswallowed():
        if _here.kept is not None:
            return _here.kept.loop(system if isinstance(system, System) else system.system, *names).run(experiment)
        with loaded(system, *names) as loop:
            return loop.run(experiment)


@contextmanager
def kept_loaded(folder: Path | None = None) -> Iterator[None]:
    """Within it a system that has been run in this thread stays loaded for its next run.

    The results are the same. What was loaded last is kept; an FMU whose file has changed is loaded anew.

    Args:
        folder: in which the FMUs are unpacked; None: that for temporary files.
    """
    kept = KeptLoops(folder)
    try:
        with kept_by(kept):
            yield
    finally:
        kept.close()


@contextmanager
def kept_by(loops: "KeptLoops") -> Iterator[None]:
    """Within it the systems that are run in this thread are kept loaded there."""
    outer, _here.kept = _here.kept, loops
    try:
        yield
    finally:
        _here.kept = outer


def kept_here() -> "KeptLoops | None":
    """Where the systems that are run in this thread are kept loaded; None: nowhere."""
    return _here.kept


class KeptLoops:
    """The loops that ran last."""

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder
        self._loops: dict[Hashable, tuple[ExitStack, Loop | IsolatedLoop]] = {}

    def loop(self, system: System, inputs: Iterable[str], parameters: Iterable[str]) -> Loop | IsolatedLoop:
        """The loop of a system after reset, or as `loaded` gives it."""
        key = system.key, *map(version, system.instances.values())
        stack, loop = self._loops.pop(key, (ExitStack(), None))
        try:
            if loop is not None:
                loop.reset()
        except SimulationError:
            stack.close()
            loop = None
        if loop is None:
            while len(self._loops) >= MOST_KEPT:
                self._loops.pop(next(iter(self._loops)))[0].close()
            loop = stack.enter_context(loaded(system, inputs, parameters, self._folder))
        self._loops[key] = stack, loop
        return loop

    def close(self) -> None:
        """Unloads them all."""
        with ExitStack() as stack:
            while self._loops:
                stack.callback(self._loops.popitem()[1][0].close)


class _Thread(local):
    """Each thread has its own: two that step the same instances end the process."""

    kept: KeptLoops | None = None


_here = _Thread()

"""Loading the FMUs of a system: ours into this process, for speed; with one that is not ours, all into another.

The steps of a loop are then made in that process as they would be in this one, and so are the results.
"""

import logging
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from toolground.collected_warnings import warn_once
from toolground.progress import progress

from .compiled_steps import LIBRARY, CompiledSteps, why_not
from .errors import SimulationError
from .experiment import Experiment
from .instance import label
from .isolated_process import IsolatedProcess
from .master import KEPT, Loop, opened
from .results import Ended, Results
from .row_layout import Layout
from .schedule import described, transfers
from .steps import MakeSteps, interpreted
from .system import System
from .wiring import Fit, fitted_for, require, unknown

LOG = logging.getLogger(__name__)


class IsolatedLoop:
    """Loaded FMUs that run together in a process of their own; see `fmuloop.master.Loop`."""

    def __init__(self, isolated: IsolatedProcess, fitted: Fit) -> None:
        self._isolated = isolated
        self._fitted = fitted

    def reset(self) -> None:
        """As `Loop.reset`."""
        self._isolated.ask(_reset)

    def run(self, experiment: Experiment) -> Results:
        """As `Loop.run`.

        Raises:
            WiringError: inputs or parameters do not fit the FMUs.
            SimulationError: an FMU refused a call, ended the process, crashed, or did not return from a call.
        """
        time = experiment.time()
        require(unknown(self._fitted, experiment.inputs, experiment.parameters))
        samples = experiment.samples(time)
        layout = Layout(self._fitted.interfaces, [name for name in samples if name not in self._fitted.absent])
        size = len(time) * layout.recorded.itemsize
        sent = replace(experiment, inputs=samples, parameters=dict(experiment.parameters))
        with progress(len(time) - 1, experiment.label) as done:
            rows = self._isolated.fetch(size, _run, sent, watch=lambda now: done(round(now / experiment.step_size)))
        results = Results(np.frombuffer(rows, layout.recorded), layout.units)
        ended, steps = self._isolated.ask(_ended), self._isolated.ask(_own_steps)
        results.own_steps = dict(zip(steps[::2], map(float, steps[1::2]), strict=True))
        if ended:
            results = results[: int(ended[0])]
            results.ended = Ended(ended[1], float(results["time"][-1]))
        try:
            remarks = self._isolated.ask(_finish)
        except SimulationError as error:
            # FMUs crash in fmi2FreeInstance, or refuse fmi2Terminate, when all rows are there
            remarks = [f"{error}; {KEPT}"]
        for text in remarks:
            LOG.warning(text)
        return results


@contextmanager
def loaded(
    system: System | Fit,
    inputs: Iterable[str] = (),
    parameters: Iterable[str] = (),
    folder: Path | None = None,
    make_steps: MakeSteps = CompiledSteps if LIBRARY else interpreted,
) -> Iterator[Loop | IsolatedLoop]:
    """The FMUs of a system, loaded and wired, for any number of runs. Afterwards they are gone.

    Args:
        system: or what is known of it already.
        inputs, parameters: `instance.variable` of those that the runs will give, if they are known, so that
            all that is wrong is named at once.
        folder: in which the FMUs are unpacked; None: that for temporary files.
        make_steps: CompiledSteps or interpreted; the results are the same.

    Raises:
        WiringError: the FMUs do not fit together, or do not fit the inputs and parameters.
        SimulationError: an FMU cannot be loaded.
    """
    fitted = fitted_for(system, inputs, parameters)
    if reason := why_not():
        warn_once(reason)
    warn_of_absent(fitted)
    LOG.info("under the propagated scheme, %s", described(transfers(fitted.system, fitted.interfaces)))
    # an FMU that exits, crashes or hangs would take the caller with it
    load = _here if fitted.interfaces.keys() <= fitted.system.own else _isolated
    with load(fitted, folder, make_steps) as loop:
        yield loop


def warn_of_absent(fitted: Fit) -> None:
    """Says once what the loop runs without, a line for each FMU."""
    for file, names in groupby(fitted.absent, fitted.file):
        warn_once(f"{file}: the loop runs without {', '.join(names)}")


_here: Callable[[Fit, Path | None, MakeSteps], Any] = opened


@contextmanager
def _isolated(fitted: Fit, folder: Path | None, make_steps: MakeSteps) -> Iterator[IsolatedLoop]:
    names = [label(*item) for item in fitted.interfaces.items()]
    isolated = IsolatedProcess(names, fitted.system.limits.call, folder)
    try:
        isolated.ask(_load, fitted, make_steps)
        yield IsolatedLoop(isolated, fitted)
        if isolated.alive:
            try:
                isolated.ask(_unload)
            except SimulationError as error:
                LOG.warning(f"{error}; {KEPT}")
    finally:
        isolated.close()


# what follows runs in the other process

_loop: Loop
_loading = ExitStack()


def _load(fitted: Fit, make_steps: MakeSteps) -> None:
    global _loop
    _loop = _loading.enter_context(opened(fitted, None, make_steps))


def _reset() -> None:
    _loop.reset()


_rows = 0


def _run(experiment: Experiment) -> memoryview:
    """All rows, of zeros behind the end."""
    global _rows
    results = _loop.rows(experiment)
    _rows = len(results)
    rows = results.view(np.uint8)
    lacking = (len(experiment.time()) - len(results)) * results.itemsize
    return (np.concatenate([rows, np.zeros(lacking, np.uint8)]) if lacking else rows).data


def _ended() -> list[str]:
    """How many rows there are, and by which FMU, where one has ended the run."""
    return [] if _loop.ended is None else [str(_rows), _loop.ended.instance]


def _own_steps() -> list[str]:
    """FMUs and their steps in s, by turns."""
    return [text for name, own in _loop.own_steps().items() for text in (name, repr(own))]


def _finish() -> list[str]:
    return _loop.finish()


def _unload() -> None:
    _loading.close()

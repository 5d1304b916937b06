"""Cases side by side: their functions take turns, each up to its next run, and runs that are alike are made in lanes.

One function is at work at a time, so that it need not be prepared for others.
"""

import os
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from contextvars import copy_context
from dataclasses import dataclass
from functools import partial
from threading import Lock, Thread
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

from toolground.interruption import uninterrupted_children
from toolground.lanes_here import lanes_here

from .experiment import Experiment
from .lanes import LaneLoop
from .master import Loop
from .results import Results
from .runs import KeptLoops, kept_by, kept_here
from .system import Scheme, System

MANY = 32
"""Cases from which on their runs are made in lanes, on however many cores: the last bits are those of lanes then. So
many take turns: where their runs differ, enough are alike to fill the lanes."""


class Outcome(NamedTuple):
    """Of a case."""

    answer: Any
    error: BaseException | None


@dataclass(frozen=True)
class BatchedRuns:
    """A function whose cases are answered side by side, their runs in batches."""

    function: Callable[[Any], Any]


def outcomes(function: Callable[[Any], Any] | BatchedRuns, cases: Sequence[Any]) -> Iterator[Outcome]:
    """Those of cases, in their order; systems are kept loaded where this thread keeps them."""
    if not isinstance(function, BatchedRuns):
        yield from (_outcome(function, case) for case in cases)
        return
    loops = kept_here()
    assert loops is not None
    for first in range(0, len(cases), MANY):
        yield from _answered(function.function, cases[first : first + MANY], loops)


def _outcome(function: Callable[[Any], Any], case: Any) -> Outcome:
    try:
        return Outcome(function(case), None)
    except BaseException as error:
        return Outcome(None, error)


class _Stopped(BaseException):
    """Nobody waits for the answer any more."""


class _RunRequest(NamedTuple):
    """A run."""

    system: System
    experiment: Experiment

    def key(self) -> Hashable:
        """The same for runs that can be made in lanes together."""
        experiment = self.experiment
        return self.system.key, experiment.step_size, Scheme(experiment.scheme), tuple(experiment.inputs)


class _Turn(KeptLoops):
    """A thread in which the function of one case after the other is at work, while another thread waits for it to ask
    for a run.

    Attributes:
        request: the run that it waits for; None: it has ended.
        outcome: once it has ended.
    """

    def __init__(self) -> None:
        super().__init__(None)
        self.request: _RunRequest | None = None
        self.outcome: Outcome | None = None
        self._reply: Any = None
        self._mine, self._yours = Lock(), Lock()
        for lock in (self._mine, self._yours):
            lock.acquire()
        Thread(target=self._work, daemon=True).start()

    def begin(self, function: Callable[[Any], Any], case: Any) -> None:
        """Goes on with a case."""
        context = copy_context()
        self.go_on(lambda: context.run(_outcome, function, case))

    def go_on(self, reply: Any) -> None:
        """Gives it what it waits for, the results that it has asked for, or an error, and waits until it asks again or
        has ended."""
        self._reply = reply
        self._mine.release()
        self._yours.acquire()

    def stop(self) -> None:
        """Ends it as soon as it asks again or has ended its case, and does not wait."""
        self._reply = _Stopped()
        if self._mine.locked():
            self._mine.release()

    def loop(self, system: System, inputs: Iterable[str], parameters: Iterable[str]) -> Any:
        """What asks for runs of a system."""
        return _RequestedLoop(self, system)

    def results_of(self, request: _RunRequest) -> Results:
        """In its thread: gets the results of a run."""
        self.request = request
        self._yours.release()
        self._mine.acquire()
        if isinstance(self._reply, BaseException):
            raise self._reply
        return self._reply

    def _work(self) -> None:
        with kept_by(self):
            while self._mine.acquire() and not isinstance(self._reply, _Stopped):
                self.outcome, self.request = self._reply(), None
                if isinstance(self._reply, _Stopped):
                    return
                self._reply = None  # nor does it keep results
                self._yours.release()


_idle: list[_Turn] = []
"""Those whose case has ended: to begin one takes longer than to bring an FMU to its first step."""

if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=lambda: _idle.clear())  # threads do not go with a fork


class _RequestedLoop(NamedTuple):
    """A loop for the function of a case."""

    turn: _Turn
    system: System

    def run(self, experiment: Experiment) -> Results:
        """As `Loop.run`."""
        return self.turn.results_of(_RunRequest(self.system, experiment))


def _answered(function: Callable[[Any], Any], cases: Sequence[Any], loops: KeptLoops) -> list[Outcome]:
    with uninterrupted_children():
        turns = [_idle.pop() if _idle else _Turn() for _ in cases]
    try:
        for turn, case in zip(turns, cases, strict=True):
            turn.begin(function, case)
        while requests := [(turn, turn.request, turn.request.key()) for turn in turns if turn.request]:
            ((most, _),) = Counter(key for _, _, key in requests).most_common(1)
            alike = [(turn, run) for turn, run, key in requests if key == most][: lanes_here() or None]
            for (turn, _), reply in zip(alike, _made([run for _, run in alike], loops), strict=True):
                turn.go_on(reply)
    except BaseException:
        for turn in turns:
            turn.stop()
        raise
    found = [turn.outcome for turn in turns if turn.outcome]
    for turn in turns:
        turn.outcome = None
    _idle.extend(turns)
    return found


def _made(requests: Sequence[_RunRequest], loops: KeptLoops) -> list[Results | BaseException]:
    """The results of runs of one system, or the errors."""
    found: list[Results | BaseException | None] = [None] * len(requests)
    lanes = _in_lanes(requests[0], loops)
    if lanes is not None:
        found = list[Results | BaseException | None](lanes([run.experiment for run in requests]))
    return [_alone(run, loops) if each is None else each for run, each in zip(requests, found, strict=True)]


def _alone(request: _RunRequest, loops: KeptLoops) -> Results | BaseException:
    system, experiment = request
    try:
        return loops.loop(system, experiment.inputs, experiment.parameters).run(experiment)
    except Exception as error:
        return error


_lane_loops: WeakKeyDictionary[Loop, LaneLoop | None] = WeakKeyDictionary()
"""Those of loops that are loaded; None: they have none."""


def _in_lanes(request: _RunRequest, loops: KeptLoops) -> Callable[[list[Experiment]], list[Any]] | None:
    """What makes runs of a system in lanes; None if that is not possible."""
    system, experiment = request
    try:
        loop = loops.loop(system, experiment.inputs, experiment.parameters)
    except Exception:
        return None
    if not isinstance(loop, Loop):
        return None
    if loop not in _lane_loops:
        plain = all(each.fmi == 2 and not each.factors for each in loop.fitted.interfaces.values())
        libraries = system.lane_libraries(system) if plain and system.lane_libraries else None
        _lane_loops[loop] = LaneLoop(loop.fitted, libraries) if libraries else None
    in_lanes = _lane_loops[loop]
    if in_lanes is None:
        return None
    return partial(in_lanes.run, loop)

"""Cases that say which runs they need and then judge their results; runs that are alike are made in lanes."""

from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice
from typing import Any, NamedTuple, TypeVar
from weakref import WeakKeyDictionary

from toolground.lanes_here import lanes_here

from .experiment import Experiment
from .lanes import LaneLoop
from .master import Loop
from .results import Results
from .runs import KeptLoops, kept_here, run
from .system import Scheme, System
from .wiring import Fit

MANY = 32
"""Cases from which on their runs are made in lanes, on however many cores: the last bits are those of lanes then. So
many are planned at a time: where their runs differ, enough are alike to fill the lanes."""

Case = TypeVar("Case")


@dataclass(frozen=True, eq=False)
class RunRequest:
    """A run that a case needs; one that is in the plans of several cases is made once for those of a batch.

    Attributes:
        system: or what is known of it already.
        finish: what is done with the results, which it gets from the function that it is given, or the error.
    """

    system: System | Fit
    experiment: Experiment
    finish: Callable[[Callable[[], Results]], Any] = lambda make: make()

    @property
    def wiring(self) -> System:
        """The system by itself."""
        return self.system if isinstance(self.system, System) else self.system.system

    def results(self) -> Any:
        """Makes the run by itself."""
        return self.finish(partial(run, self.system, self.experiment))

    def key(self) -> Hashable:
        """The same for runs that can be made in lanes together."""
        experiment = self.experiment
        return self.wiring.key, experiment.step_size, Scheme(experiment.scheme), tuple(experiment.inputs)


class Outcome(NamedTuple):
    """Of a case or a run."""

    answer: Any
    error: BaseException | None

    def get(self) -> Any:
        """The answer, or raises the error."""
        if self.error is not None:
            raise self.error
        return self.answer


class RunResults(Sequence[Any]):
    """Those of the runs of a case, in the order of its plan. To get one whose run had an error raises that."""

    def __init__(self, outcomes: Iterable[Outcome]) -> None:
        self._outcomes = list(outcomes)

    def __len__(self) -> int:
        return len(self._outcomes)

    def __getitem__(self, index: int | slice) -> Any:
        if isinstance(index, slice):
            return RunResults(self._outcomes[index])
        return self._outcomes[index].get()


@dataclass(frozen=True)
class Campaign:
    """A function of cases.

    Attributes:
        plan: the runs that a case needs.
        judge: what it gives, from the case and their results.
    """

    plan: Callable[[Any], Sequence[RunRequest]]
    judge: Callable[[Any, Sequence[Any]], Any]
    in_lanes: bool

    def __call__(self, case: Any) -> Any:
        """The answer of a case by itself."""
        return self.judge(case, RunResults(_run(request.results) for request in self.plan(case)))


def outcomes(function: Callable[[Any], Any], cases: Sequence[Any]) -> Iterator[Outcome]:
    """Those of cases, in their order; systems are kept loaded where this thread keeps them."""
    loops = kept_here()
    if not (isinstance(function, Campaign) and function.in_lanes and loops):
        yield from (_answered(function, case) for case in cases)
        return
    for part in batched(cases, MANY):
        yield from _planned(function, part, loops)


def _planned(campaign: Campaign, cases: Sequence[Any], loops: KeptLoops) -> Iterator[Outcome]:
    plans = [_answered(campaign.plan, case) for case in cases]
    made = _made(dict.fromkeys(request for plan in plans for request in plan.answer or ()), loops)
    for case, plan in zip(cases, plans, strict=True):
        if plan.error is not None:
            yield plan
            continue
        results = RunResults(made[request] for request in plan.answer)
        yield _answered(campaign.judge, case, results)


def _made(requests: Iterable[RunRequest], loops: KeptLoops) -> dict[RunRequest, Outcome]:
    """What comes of runs: those that are alike are made together, those of the same length next to each other."""
    groups: dict[Hashable, list[RunRequest]] = {}
    for request in requests:
        groups.setdefault(request.key(), []).append(request)
    made: dict[RunRequest, Outcome] = {}
    for group in groups.values():
        group.sort(key=lambda request: (request.experiment.duration, id(request.experiment.inputs)))
        for together in batched(group, lanes_here()):
            for request, make in zip(together, _in_lanes(together, loops), strict=True):
                made[request] = _run(request.finish, make)
    return made


def _in_lanes(requests: Sequence[RunRequest], loops: KeptLoops) -> list[Callable[[], Results]]:
    """What gives the results of runs that are alike."""
    lanes = _lanes_of(requests[0], loops)
    tables = lanes([request.experiment for request in requests]) if lanes else [None] * len(requests)
    return [
        partial(run, request.system, request.experiment) if table is None else _outcome_of(table).get
        for request, table in zip(requests, tables, strict=True)
    ]


def _outcome_of(table: Results | Exception) -> Outcome:
    return Outcome(None, table) if isinstance(table, Exception) else Outcome(table, None)


_lane_loops: WeakKeyDictionary[Loop, LaneLoop | None] = WeakKeyDictionary()
"""Those of loops that are loaded; None: they have none."""


def _lanes_of(
    request: RunRequest, loops: KeptLoops
) -> Callable[[list[Experiment]], list[Results | Exception | None]] | None:
    """What makes runs of a system in lanes; None if that is not possible."""
    system, experiment = request.wiring, request.experiment
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
    lane_loop = _lane_loops[loop]
    return partial(lane_loop.run, loop) if lane_loop else None


def _answered(function: Callable[..., Any], *arguments: Any) -> Outcome:
    """What comes of a function of the user, which may end the process too."""
    try:
        return Outcome(function(*arguments), None)
    except BaseException as error:
        return Outcome(None, error)


def _run(make: Callable[..., Any], *arguments: Any) -> Outcome:
    """What comes of a run; an interruption ends them all."""
    try:
        return Outcome(make(*arguments), None)
    except Exception as error:
        return Outcome(None, error)


def batched(cases: Iterable[Case], size: int) -> Iterator[list[Case]]:
    """So many at a time, the last ones fewer; what comes later is not asked for yet."""
    left = iter(cases)
    while batch := list(islice(left, size)):
        yield batch

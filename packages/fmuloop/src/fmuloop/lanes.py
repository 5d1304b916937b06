"""The steps of several runs of a loop at a time, one in each lane of the processor's vectors.

The FMUs bring each run to its first step; libraries of their blocks (fmublocks.native.lanes) take over their saved
states. The schedule is that of single runs, and what differs is the rounding of products that are added, and of sine
and the like. A run that an FMU would refuse something is given up here; alone it says what.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from ctypes import CDLL, Array, Structure, c_double, c_int, c_long, c_size_t, c_uint, c_void_p, cast
from typing import NamedTuple
from weakref import finalize

import numpy as np

from toolground.progress import chunks, progress

from .bound_calls import Wires
from .experiment import Experiment
from .master import Loop
from .results import Results
from .row_layout import Layout
from .schedule import Action, Get, GetRates, Move, Set, Step, Transfer, schedule
from .system import Scheme
from .wiring import Fit


class _Action(Structure):
    """`Action` in lane_loop.c."""

    _fields_ = (
        ("call", c_void_p),
        ("block", c_void_p),
        ("count", c_size_t),
        ("from_", c_void_p),
        ("to", c_void_p),
        ("is_line", c_int),
    )


class _Column(Structure):
    """`Column` in lane_loop.c."""

    _fields_ = (("offset", c_size_t), ("is_whole", c_int))


class _Table(Structure):
    """`Table` in lane_loop.c."""

    _fields_ = (("rows", c_void_p), ("count", c_size_t))


class Block:
    """Instances of a block in lanes.

    Attributes:
        lanes: how many.
    """

    def __init__(self, library: CDLL, references: Mapping[str, int]) -> None:
        self.library = library
        self.lanes = c_int.in_dll(library, "lanes_width").value
        self._references = references
        for name in ("lanes_new", "lanes_place", "lanes_rate"):
            getattr(library, name).restype = c_void_p
        library.lanes_alone.restype = c_long
        self.address = c_void_p(library.lanes_new())
        if not self.address:
            raise MemoryError
        finalize(self, library.lanes_free, self.address)

    def load(self, lane: int, state: c_void_p, counts: bool) -> None:
        """The saved state of an instance goes into a lane."""
        self.library.lanes_load(self.address, lane, state, int(counts))

    def place(self, variable: str) -> int:
        """Where its values are."""
        return self.library.lanes_place(self.address, c_uint(self._references[variable]))

    def rate(self, variable: str) -> int:
        """Where the rates of change of an input or output are."""
        return self.library.lanes_rate(self.address, c_uint(self._references[variable]))

    def is_lost(self, lane: int) -> bool:
        """Whether what is in that lane has been given up."""
        return bool(self.library.lanes_lost(self.address, lane))

    @property
    def alone(self) -> int:
        """Steps that were made alone."""
        return self.library.lanes_alone(self.address)


class _Plan(NamedTuple):
    """What is given to lanes_run, see there; `kept` has the memory that it points to."""

    actions: "Array[_Action]"
    turn: int
    columns: "Array[_Column]"
    known: int
    row: np.ndarray
    kept: object


class LaneLoop:
    """A loop whose runs are made in lanes.

    Args:
        libraries: of the blocks, by the names of the instances.

    Attributes:
        lanes: how many.
    """

    def __init__(self, fitted: Fit, libraries: Mapping[str, CDLL]) -> None:
        self._fitted = fitted
        self._blocks = {
            name: Block(libraries[name], {v.name: v.valueReference for v in interface.variables.values()})
            for name, interface in fitted.interfaces.items()
        }
        self._plans: dict[tuple[Scheme, tuple[str, ...]], _Plan] = {}
        first = next(iter(self._blocks.values()))
        self.lanes, self._run = first.lanes, first.library.lanes_run

    @property
    def alone(self) -> int:
        """Steps of blocks that a car made alone, in all runs."""
        return sum(block.alone for block in self._blocks.values())

    def run(self, loop: Loop, experiments: Sequence[Experiment]) -> list[Results | Exception | None]:
        """The results of at most as many experiments as there are lanes, with one step size, one scheme and the same
        inputs, or the error with which one began; None: it was given up, or changes parameters, or is so long that its
        rows are in a file.

        Args:
            loop: of the same system, whose FMUs bring the runs to their first step.
        """
        tables: list[Results | Exception | None] = []
        layout: Layout | None = None
        before: tuple[Experiment, Wires, Results] | None = None
        for lane, experiment in enumerate(experiments):
            try:
                alike = before[1:] if before and _are_alike(before[0], experiment) else None
                wires, table, due = loop.begin(experiment, alike)
            except Exception as error:
                tables.append(error)
                continue
            if due or table.file is not None:
                tables.append(None)
                continue
            if layout is None:  # every lane needs something to compute with
                self._load(loop, range(self.lanes), counts=False)
            self._load(loop, [lane], counts=True)
            layout = wires.layout
            tables.append(table)
            before = experiment, wires, table
        if layout is None:
            return [table if isinstance(table, Exception) else None for table in tables]
        self._step(experiments[0], layout, tables)
        return [self._result(lane, layout, table) for lane, table in enumerate(tables)]

    def _result(self, lane: int, layout: Layout, table: Results | Exception | None) -> Results | Exception | None:
        if not isinstance(table, Results):
            return table
        return None if self._is_lost(lane) else layout.results(table, are_truths=True)

    def _load(self, loop: Loop, lanes: Iterable[int], counts: bool) -> None:
        for instance in loop.instances:
            state = instance.call("getFMUstate")
            for lane in lanes:
                self._blocks[instance.name].load(lane, state, counts)
            instance.call("freeFMUstate", state)

    def _is_lost(self, lane: int) -> bool:
        return any(block.is_lost(lane) for block in self._blocks.values())

    def _step(self, experiment: Experiment, layout: Layout, tables: Sequence[Results | Exception | None]) -> None:
        """Makes all steps."""
        key = Scheme(experiment.scheme), tuple(experiment.inputs)
        if key not in self._plans:
            self._plans[key] = self._planned(key[0], layout)
        plan = self._plans[key]
        good = [table for table in tables if isinstance(table, Results)]
        spare = _Table(good[0].ctypes.data, 1)
        rows = [
            _Table(table.ctypes.data, len(table)) if isinstance(table, Results) else spare
            for table in [*tables, *[None] * (self.lanes - len(tables))]
        ]
        last = max(map(len, good)) - 1
        with progress(last, experiment.label) as done:
            for chunk in chunks(last, 1000):
                self._run(
                    *(plan.actions, c_size_t(plan.turn), c_size_t(len(plan.actions)), c_double(experiment.step_size)),
                    *(plan.columns, c_size_t(plan.known), c_size_t(len(plan.columns)), c_void_p(plan.row.ctypes.data)),
                    *((_Table * self.lanes)(*rows), c_size_t(layout.dtype.itemsize)),
                    *(c_size_t(chunk.start), c_size_t(chunk.stop)),
                )
                done(chunk.stop)

    def _planned(self, scheme: Scheme, layout: Layout) -> _Plan:
        return _Binding(self._fitted, self._blocks, layout).plan(scheme)


class _Binding:
    """Makes the actions of a schedule in lanes, which work on a row with the columns of the results and, behind these,
    rates of change of outputs."""

    def __init__(self, fitted: Fit, blocks: Mapping[str, Block], layout: Layout) -> None:
        self._fitted = fitted
        self._blocks = blocks
        self._fields = {name: (kind, int(offset)) for name, (kind, offset, *_) in (layout.dtype.fields or {}).items()}
        self._known = sum(offset < layout.known for _, offset in self._fields.values())
        self._columns = list(self._fields)
        self._feeds = {target: source for source, target, _ in self._fitted.system.connections}
        self._sources = {name: name for name in self._columns[1 : self._known]} | self._feeds

    def plan(self, scheme: Scheme) -> _Plan:
        """What is done in a step."""
        begin, end = schedule(scheme, self._fitted.system, self._fitted.interfaces)
        read = [(f"{a.instance}.{name}", a.at_end) for a in begin if isinstance(a, GetRates) for name in a.outputs]
        lanes = next(iter(self._blocks.values())).lanes
        row = _aligned((len(self._columns) + len(read), lanes))
        size = row.strides[0]
        self._places = {name: row.ctypes.data + size * k for k, name in enumerate(self._columns)}
        self._rates = {rate: row.ctypes.data + size * (len(self._columns) + k) for k, rate in enumerate(read)}
        bound = [[call for action in part for call in self._bound(action)] for part in (begin, end)]
        actions = [*bound[0], *bound[1]]
        columns = [_Column(offset, kind.kind == "i") for kind, offset in self._fields.values()]
        return _Plan(
            (_Action * len(actions))(*actions),
            len(bound[0]),
            (_Column * len(columns))(*columns),
            self._known,
            row,
            [action.kept for action in actions],
        )

    def _bound(self, action: Action) -> Iterator[_Action]:
        name, block = action.instance, self._blocks[action.instance]
        match action:
            case Set():
                fed = [target for target in self._sources if target.startswith(f"{name}.")]
                pairs = [(self._places[self._sources[t]], block.place(t.partition(".")[2])) for t in fed]
                yield _action(block, "lanes_set", pairs)
            case Step():
                yield _action(block, "lanes_step")
            case Get(_, outputs):
                yield _action(block, "lanes_outputs")
                yield _action(block, None, [(block.place(o), self._places[f"{name}.{o}"]) for o in outputs])
            case GetRates(_, outputs, at_end):
                yield _action(block, "lanes_rates")
                yield _action(block, None, [(block.rate(o), self._rates[f"{name}.{o}", at_end]) for o in outputs])
            case Move(_, inputs, transfer):
                for variable in inputs:
                    source = self._feeds[f"{name}.{variable}"]
                    follows = transfer is Transfer.EXTRAPOLATED
                    end = None if follows else self._places[source]
                    rates = [self._rates.get((source, at_end)) for at_end in (False, True)]
                    yield _line([end, *rates], [block.place(variable), block.rate(variable)])


def _are_alike(first: Experiment, second: Experiment) -> bool:
    """Whether what is known in advance is the same."""
    return first.inputs is second.inputs and (first.duration, first.step_size) == (second.duration, second.step_size)


def _action(block: Block, function: str | None, pairs: Sequence[tuple[int, int]] = ()) -> _Action:
    action = _Action(block=block.address, count=len(pairs))
    action.call = cast(getattr(block.library, function), c_void_p) if function else None
    action.kept = [(c_void_p * len(pairs))(*places) for places in zip(*pairs, strict=True)]
    if pairs:
        action.from_, action.to = (cast(array, c_void_p) for array in action.kept)
    return action


def _line(from_: Sequence[int | None], to: Sequence[int]) -> _Action:
    action = _Action(is_line=1)
    action.kept = [(c_void_p * len(places))(*places) for places in (from_, to)]
    action.from_, action.to = (cast(array, c_void_p) for array in action.kept)
    return action


def _aligned(shape: tuple[int, int]) -> np.ndarray:
    """Zeros, from a multiple of their second dimension on."""
    count, size = shape[0] * shape[1], shape[1] * 8
    memory = np.zeros(count + shape[1])
    first = -memory.ctypes.data % size // 8
    return memory[first : first + count].reshape(shape)

"""Records of all shapes become structs of C: records in records, arrays of them, empty ones."""

import math
from typing import Annotated, NamedTuple

import pytest

from driveline.fmus.fmu import Fmu
from driveline.fmus.native.records import records_of, structs
from driveline.models.block.declaration import Boolean, Real
from driveline.models.block.operators import maximum
from driveline.models.block.runner import runner
from driveline.models.block.types import SampledBlock
from tests.fmus.host import opened


class Nothing(NamedTuple):
    """What a part remembers that remembers nothing."""


class Input(NamedTuple):
    u: Annotated[float, Real("1", "a number")] = 0.5


class Output(NamedTuple):
    y: Annotated[float, Real("1", "the oldest number, and the mean of all")]


class Message(NamedTuple):
    """A number on its way."""

    number: Annotated[float, Real("m", "the number")]
    valid: Annotated[bool, Boolean("whether it is one")]


class Mean(NamedTuple):
    """The mean of all numbers. It is that of what has arrived
    so far."""

    last: Message
    sum: Annotated[float, Real("1", "sum of the numbers")]
    count: Annotated[float, Real("1", "how many there were")]


class State(NamedTuple):
    mean: Mean
    law: Nothing
    under_way: Annotated[tuple[Message, ...], Real("1", "newest first")]
    matrix: Annotated[tuple[tuple[float, ...], ...], Real("1", "two rows")]


def start(u: Input, p: Nothing) -> State:
    message = Message(u.u, False)
    return State(Mean(message, 0.0, 0.0), Nothing(), (message,) * 3, ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0)))


def update(x: State, u: Input, p: Nothing) -> State:
    sent = Message(u.u, u.u > 0.0)
    first, second = x.matrix
    return State(
        mean=Mean(x.under_way[-1], x.mean.sum + x.under_way[-1].number, x.mean.count + 1.0),
        law=x.law,
        under_way=(sent, *x.under_way[:-1]),
        matrix=(second, (first[2], first[0], first[1] * u.u)),
    )


def output(x: State, u: Input, p: Nothing) -> Output:
    return Output(x.mean.last.number + x.mean.sum / maximum(x.mean.count, 1.0) + sum(x.matrix[0]) * x.matrix[1][2])


BLOCK = SampledBlock(
    name="Nested",
    description="Numbers under way",
    module=__name__,
    Parameters=Nothing,
    Input=Input,
    State=State,
    Output=Output,
    start=start,
    output=output,
    update=update,
    sample_time=0.01,
)

STRUCTS = """\
typedef struct {
    real u;  /* a number */
} Input;

typedef struct {
    real none;  /* in C a struct is not empty */
} Parameters;

typedef struct {
    real y;  /* the oldest number, and the mean of all */
} Output;

typedef struct {
    real number;  /* m: the number */
    real valid;   /* whether it is one */
} Message;

typedef struct {
    Message last;  /* A number on its way */
    real sum;      /* sum of the numbers */
    real count;    /* how many there were */
} Mean;

typedef struct {
    Mean mean;             /* The mean of all numbers */
    Message under_way[3];  /* newest first */
    real matrix[2][3];     /* two rows */
} State;"""


def test_each_record_is_a_struct_with_the_declared_meanings():
    assert "\n\n".join(structs(records_of(BLOCK))) == STRUCTS


def test_two_records_of_one_name_are_refused():
    class Mean(NamedTuple):
        other: Annotated[float, Real("1", "another mean")] = 0.0

    with pytest.raises(ValueError, match="Mean is the name of two records"):
        list(structs(records_of(BLOCK) | {"y": (BLOCK.start(Input(), Nothing()).mean, Mean())}))


def test_a_block_of_such_records_runs_in_c_as_in_python(native_builder, tmp_path):
    path = native_builder(Fmu(BLOCK, stop_time=1.0), tmp_path)
    reference = runner(BLOCK, Input(), Nothing())
    with opened(path, tmp_path / "unpacked") as host:
        host.initialize()
        for k in range(20):
            u = Input(math.sin(k))
            host.set(u=u.u)
            host.step(0.01 * k, 0.01)
            reference.advance(u, 0.01)
            assert host.get("y") == reference.output(u).y
        saved = host.fmu.getFMUstate()
        host.step(0.2, 0.05)
        after = host.get("y")
        host.fmu.setFMUstate(saved)
        host.step(0.2, 0.05)
        assert host.get("y") == after

"""Records, and terms that depend on parameters alone, in C."""

import math
from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

import pytest
from fmutesting.host import opened
from fmutesting.recorded import recorded
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from fmublocks.block.declaration import Boolean, Real
from fmublocks.block.operators import maximum, sqrt, where
from fmublocks.block.runner import runner
from fmublocks.block.types import SampledBlock
from fmublocks.fmu import Fmu
from fmublocks.native.records import records_of, structs
from fmublocks.native.source import block_sources
from fmublocks.native.statements import Statements
from fmublocks.native.terms import Terms


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


def test_each_record_is_a_struct_with_the_declared_meanings():
    text = "\n".join(structs(records_of(BLOCK)))
    assert "    real number;  /* m: the number */\n    real valid;   /* whether it is one */\n} Message;" in text
    assert "    Message last;  /* A number on its way */\n" in text
    assert "    real matrix[2][3];     /* two rows */\n} State;" in text
    assert "    real none;  /* in C a struct is not empty */\n} Parameters;" in text


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


def taken(*functions: Callable[..., Any]) -> tuple[Terms, list[list[str]]]:
    """The terms of functions of x, p and q, and their C without these."""
    terms, written = Terms("p->terms"), list[list[str]]()
    for of in functions:
        graph = recorded(of, ["x"], ["p", "q"])
        terms.take(graph, [1])
        written.append([line.strip() for line in Statements(graph, ["y"]).lines])
    return terms, written


def statements(terms: Terms) -> list[str]:
    return [line.strip() for line in Statements(terms, terms.names()).lines]


def test_the_inverse_of_a_parameter_is_a_term_and_a_division_by_it_is_none() -> None:
    terms, written = taken(lambda x, p, q: 1.0 / p * x, lambda x, p, q: x / p)
    assert statements(terms) == ["p->terms[0] = 1.0 / p;"]
    assert written == [["y = p->terms[0] * x;"], ["y = x / p;"]]


def test_the_largest_terms_are_taken_and_equal_ones_once() -> None:
    terms, written = taken(lambda x, p, q: (p * q + q) * x, lambda x, p, q: x - (p * q + q))
    assert statements(terms) == ["p->terms[0] = (p * q) + q;"]
    assert written == [["y = p->terms[0] * x;"], ["y = x - p->terms[0];"]]


def test_parameters_their_negatives_and_truth_values_are_no_terms() -> None:
    terms, written = taken(lambda x, p, q: where(p < q, maximum(x, -p), q))
    assert statements(terms) == []
    assert not any("terms" in line for line in written[0])


def test_a_choice_between_parameters_is_a_term() -> None:
    terms, written = taken(lambda x, p, q: maximum(p, q) * x)
    assert statements(terms) == ["p->terms[0] = (q < p) ? p : q;"]
    assert written == [["y = p->terms[0] * x;"]]


@together("p, q", [(2.0, 3.0), (-1.0, 0.0)])
def test_values_are_those_of_the_operations_also_where_they_are_infinite(p: float, q: float) -> None:
    terms, _ = taken(lambda x, p, q: x * (where(p > 0.0, sqrt(p * p), 7.0) + 1.0 / q))
    assert terms.values([p, q]) == [(p if p > 0.0 else 7.0) + (1.0 / q if q else float("inf"))]


@together("name", ["TwoMassDriveline", "ValidationVehicle"])
def test_no_stage_of_a_plant_divides_by_parameters_or_has_the_slope_in_it(name: str) -> None:
    text = block_sources(FMUS[name])["block.c"]
    stages = text.partition("derivative_held(")[2].partition("\n}")[0]
    assert "sin(u->slope)" in text
    assert "p->terms" in stages
    assert "/ p->" not in stages
    assert "slope" not in stages

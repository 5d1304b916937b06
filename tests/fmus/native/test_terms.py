"""What depends on parameters, or on parameters and held inputs alone, is computed once."""

import re
from collections.abc import Callable
from typing import Any

from driveline.fmus.catalogue import FMUS
from driveline.fmus.native.source import block_sources
from driveline.fmus.native.statements import Statements
from driveline.fmus.native.terms import Terms
from driveline.models.block.operators import maximum, sqrt, where
from tests.fmus.native.recorded import recorded
from tests.together import together


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
def test_no_stage_of_a_plant_divides_by_parameters(name: str) -> None:
    text = block_sources(FMUS[name])["block.c"].partition("derivative_held(")[2].partition("\n}")[0]
    assert "p->terms" in text
    assert "/ p->" not in text


def test_the_slope_is_no_matter_of_the_stages(native_builder: None) -> None:
    text = block_sources(FMUS["ValidationVehicle"])["block.c"]
    stages = text.partition("void derivative_held(")[2].partition("\n}")[0]
    assert "sin(u->slope)" in text
    assert "slope" not in stages


def test_at_a_stage_only_that_is_computed_again_which_an_input_moves(native_builder: None) -> None:
    text = block_sources(FMUS["ValidationVehicle"])["block.c"]
    blocks = text.partition("void held_terms(")[2].partition("\n}")[0].split("if (")[1:]
    for block in blocks:
        moves = re.match(r"!du \|\| du->(\w+) != 0\)", block)
        assert moves
        assert set(re.findall(r"\bu->(\w+)", block)) == {moves[1]}
    assert len(blocks) == 3

"""C statements of a traced function, of one car and of several at a time."""

from collections.abc import Callable
from typing import Any

from fmutesting.recorded import recorded
from fmutesting.together import together

from fmublocks.block import operators
from fmublocks.block.operators import interpolate, logical_and, sin, where
from fmublocks.native.arithmetic import LOOKED_UP
from fmublocks.native.lanes import LANES, LaneStatements
from fmublocks.native.statements import LOOPED, Statements
from fmublocks.symbol import Symbol

NAMES = [f"a[{k}]" for k in range(6)]


def written(of: Callable[..., Any], names: list[str]) -> list[str]:
    """The C of a function of so many numbers."""
    return [line.strip() for line in Statements(recorded(of, names), ["y"]).lines]


def test_an_interpolation_in_an_array_looks_its_neighbours_up() -> None:
    lines = written(lambda *v: interpolate(v[:-1], v[-1]), [*NAMES, "position"])
    index = next(line for line in lines if line.startswith("const int "))
    assert index.endswith("4 : ((1.0 <= a2) ? (int)a2 : 0);")
    assert not any("a[2]" in line for line in lines)
    assert lines[-1] == "y = a4 + ((a2 - (double)a3) * (a[a3 + 1] - a4));"


def test_a_loop_assigns_what_follows_each_other_in_arrays() -> None:
    def lines(names: list[str], of: Callable[..., Any] = lambda *v: v) -> list[str]:
        outputs = [f"y[{k + 1}]" for k in range(len(names))]
        return [line.strip() for line in Statements(recorded(of, names), outputs).lines]

    many, few = ([f"a.b[{k}]" for k in range(count)] for count in (LOOPED, LOOPED - 1))
    loop = f"for (int k = 0; k < {LOOPED}; k++) {{"
    assert lines(many) == [loop, "y[k + 1] = a.b[k];", "}"]
    assert lines(many, lambda *v: (sin(v[0]),) * LOOPED) == [
        "const double a1 = sin(a.b[0]);",
        loop,
        "y[k + 1] = a1;",
        "}",
    ]
    for others in (few, [*few, "c"], [*few, "a.b[0]"]):
        assert len(lines(others)) == len(others)


def test_numbers_that_are_no_array_are_chosen_one_by_one() -> None:
    lines = written(lambda *v: interpolate(v[:-1], v[-1]), [*"abcdef", "position"])
    assert not any("[" in line for line in lines)


def test_few_choices_are_not_looked_up() -> None:
    few = LOOKED_UP
    lines = written(lambda *v: interpolate(v[:-1], v[-1]), [*NAMES[:few], "position"])
    assert not any("(int)" in line for line in lines)


def test_a_choice_between_equal_values_is_that_value() -> None:
    assert written(lambda x, y: where(x < y, x + y, x + y), ["x", "y"]) == ["y = x + y;"]


def test_what_is_within_limits_is_not_limited_to_them_again() -> None:
    once = written(operators.clip, ["x", "low", "high"])
    assert (
        written(lambda x, low, high: operators.clip(operators.clip(x, low, high), low, high), ["x", "low", "high"])
        == once
    )
    for other in (lambda x, low, high: (x, high, low), lambda x, low, high: (x, low, x)):
        twice = written(
            lambda *v, other=other: operators.clip(*other(operators.clip(*v), *v[1:])), ["x", "low", "high"]
        )
        assert len(twice) > len(once)


def test_what_only_one_side_of_a_choice_needs_is_computed_there() -> None:
    lines = written(lambda x, y: where(x < y, x * y, x), ["x", "y"])
    assert lines == ["double a1;", "if (x < y) {", "a1 = x * y;", "} else {", "a1 = x;", "}", "y = a1;"]


def test_a_choice_that_has_been_made_is_not_made_again() -> None:
    lines = written(lambda x, y: where(x < y, 2.0 * where(x < y, x, x * y), y), ["x", "y"])
    assert sum(line.startswith("if") for line in lines) == 1
    assert "a2 = 2.0 * x;" in lines


@together(
    "of, text",
    [
        (lambda x, y: x + y + x, "x + y + x"),
        (lambda x, y: x - (y - x), "x - (y - x)"),
        (lambda x, y: x + y * x, "x + (y * x)"),
        (lambda x, y: x * y / x, "x * y / x"),
        (lambda x, y: -x * y, "-x * y"),
        (lambda x, y: where(x < y, x, y), "(x < y) ? x : y"),
        (lambda x, y: where((x < y).logical_and(y < 1.0), x, y), "((x < y) && (y < 1.0)) ? x : y"),
        (lambda x, y: where((x < y).logical_not(), x, y), "!(x < y) ? x : y"),
    ],
)
def test_operators_of_different_kinds_are_kept_apart(of: Callable[..., Any], text: str) -> None:
    assert written(of, ["x", "y"]) == [f"y = {text};"]


def written_in_lanes(of: Callable[..., Any], names: list[str]) -> list[str]:
    """The C of a function of so many numbers."""
    return [line.strip() for line in LaneStatements(recorded(of, names), ["y"], LANES).lines]


def test_a_choice_takes_both_values() -> None:
    assert written_in_lanes(lambda a, b: where(logical_and(a < b, b < 2.0), sin(a), b * b), ["a", "b"]) == [
        "y = chosen(((a < b) & (b < all_lanes(2.0))), sin_in_lanes(a), b * b);"
    ]


def test_what_only_some_cars_may_need_is_computed_if_one_does() -> None:
    def long(a: Any) -> Any:
        for n in range(1, 8):
            a = sin(a * a + float(n))
        return a

    lines = written_in_lanes(lambda a, b: where(a < b, long(a), b), ["a", "b"])
    assert lines[:2] == ["lanes a1;", "if (is_any(a < b)) {"]
    assert lines[-5:] == ["}", "if (is_any(~(a < b))) {", "a1 = chosen(a < b, a1, b);", "}", "y = a1;"]


def test_a_look_up_is_one_for_each_car() -> None:
    lines = written_in_lanes(lambda *v: interpolate(v[:-1], v[-1]), [*(f"a[{k}]" for k in range(6)), "position"])
    assert any("index_of(" in line and line.startswith("const mask ") for line in lines)
    assert any("element(&a[1], " in line for line in lines)


def test_a_constant_does_not_divide() -> None:
    assert written_in_lanes(lambda a: a / 4.0, ["a"]) == ["y = a * all_lanes(0.25);"]
    assert written_in_lanes(lambda a, b: a / b, ["a", "b"]) == ["y = a / b;"]


def test_a_symbol_has_all_that_the_operators_ask_of_it() -> None:
    asked = {name for name in vars(operators.Symbol) if not name.startswith("_")}
    assert {"where", "sin"} <= asked <= vars(Symbol).keys()

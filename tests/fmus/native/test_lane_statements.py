"""What the traced arithmetic becomes in C for several cars at a time: no car's branch is another's."""

from collections.abc import Callable
from typing import Any

from driveline.fmus.native.lane_statements import LaneStatements
from driveline.fmus.native.lanes import LANES
from driveline.models.block.operators import interpolate, logical_and, sin, where
from tests.fmus.native.recorded import recorded


def written(of: Callable[..., Any], names: list[str]) -> list[str]:
    """The C of a function of so many numbers."""
    return [line.strip() for line in LaneStatements(recorded(of, names), ["y"], LANES).lines]


def test_a_choice_takes_both_values() -> None:
    assert written(lambda a, b: where(logical_and(a < b, b < 2.0), sin(a), b * b), ["a", "b"]) == [
        "y = chosen(((a < b) & (b < all_lanes(2.0))), sin_in_lanes(a), b * b);"
    ]


def test_what_only_some_cars_may_need_is_computed_if_one_does() -> None:
    def long(a: Any) -> Any:
        for n in range(1, 8):
            a = sin(a * a + float(n))
        return a

    lines = written(lambda a, b: where(a < b, long(a), b), ["a", "b"])
    assert lines[:2] == ["lanes a1;", "if (is_any(a < b)) {"]
    assert lines[-5:] == ["}", "if (is_any(~(a < b))) {", "a1 = chosen(a < b, a1, b);", "}", "y = a1;"]


def test_a_look_up_is_one_for_each_car() -> None:
    lines = written(lambda *v: interpolate(v[:-1], v[-1]), [*(f"a[{k}]" for k in range(6)), "position"])
    assert any("index_of(" in line and line.startswith("const mask ") for line in lines)
    assert any("element(&a[1], " in line for line in lines)


def test_a_constant_does_not_divide() -> None:
    assert written(lambda a: a / 4.0, ["a"]) == ["y = a * all_lanes(0.25);"]
    assert written(lambda a, b: a / b, ["a", "b"]) == ["y = a / b;"]

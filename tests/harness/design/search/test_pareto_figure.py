"""Parameters stand in a figure as in a formula."""

import pytest

from driveline.harness.design.search.pareto_figure import MARGIN, _around, _symbol


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("k_d", "$k_{d}$"),
        ("omega_w", r"$\omega_{w}$"),
        ("T_take_max", "$T_{take_max}$"),
        ("d", "$d$"),
        ("landing_share", "landing_share"),
    ],
)
def test_a_parameter_is_a_symbol_with_its_index_and_a_word_stays_a_word(name: str, shown: str) -> None:
    assert _symbol(name) == shown


@pytest.mark.parametrize(
    ("values", "limits"),
    [([1.0, 3.0], (1.0 - 2.0 * MARGIN, 3.0 + 2.0 * MARGIN)), ([1.0], (0.98, 1.02)), ([1.0, 1.01], (0.98, 1.03))],
)
def test_points_have_a_margin_around_them_even_where_there_is_only_one(
    values: list[float], limits: tuple[float, float]
) -> None:
    assert _around(values) == pytest.approx(limits)

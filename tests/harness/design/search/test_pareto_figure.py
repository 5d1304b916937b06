"""Parameters stand in a figure as in a formula."""

import pytest

from driveline.harness.design.search.pareto_figure import _symbol


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("k_d", "$k_{d}$"),
        ("omega_w", r"$\omega_{w}$"),
        ("T_take_max", "$T_{take_max}$"),
        ("d", "$d$"),
        ("bounce", "bounce"),
    ],
)
def test_a_parameter_is_a_symbol_with_its_index_and_a_word_stays_a_word(name: str, shown: str) -> None:
    assert _symbol(name) == shown

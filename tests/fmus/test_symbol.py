"""What passes for a number while a block is traced."""

from driveline.fmus.symbol import Symbol
from driveline.models.block import operators


def test_a_symbol_has_all_that_the_operators_ask_of_it() -> None:
    asked = {name for name in vars(operators.Symbol) if not name.startswith("_")}
    assert {"where", "sin"} <= asked <= vars(Symbol).keys()

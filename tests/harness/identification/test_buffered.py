"""A function of CasADi is called with arrays of numpy."""

import casadi as ca
import numpy as np
import pytest

from driveline.harness.identification.buffered import Buffered

X, Y = ca.SX.sym("X", 2, 3), ca.SX.sym("y")
FUNCTION = ca.Function("f", [X, Y], [X * Y, ca.sum1(X)])


def test_it_gives_what_a_call_gives() -> None:
    x = np.arange(6.0).reshape(2, 3)
    for found, expected in zip(Buffered(FUNCTION)(x, np.array([2.5])), FUNCTION(x, 2.5), strict=True):
        np.testing.assert_array_equal(found, np.asarray(expected))


def test_the_next_call_overwrites_it() -> None:
    call = Buffered(FUNCTION)
    first, _ = call(np.ones((2, 3)), np.array([1.0]))
    call(np.ones((2, 3)), np.array([2.0]))
    np.testing.assert_array_equal(first, np.full((2, 3), 2.0))


@pytest.mark.parametrize("given", [(np.ones((2, 2)), np.ones(1)), (np.ones((2, 3)),)])
def test_too_little_is_refused(given: tuple[np.ndarray, ...]) -> None:
    with pytest.raises(ValueError, match=r"could not broadcast|shorter"):
        Buffered(FUNCTION)(*given)

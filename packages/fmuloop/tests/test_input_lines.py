"""The lines along which inputs move: as near to what the source did as a line can be."""

from ctypes import c_double

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import Polynomial

from fmuloop.input_lines import Line, slope, start

values = st.floats(-1e3, 1e3)
steps = st.floats(1e-5, 1e-1)
factors = st.sampled_from([1.0, 1e-3, 2.0])


def along(sent, factor=1.0, **known):
    return Line(c_double(sent), factor, **{name: c_double(value) for name, value in known.items()})


@given(st.lists(values, min_size=4, max_size=4), steps, factors)
def test_a_line_has_the_mean_and_the_first_moment_of_the_cubic_that_it_stands_for(coefficients, h, factor):
    cubic = Polynomial(coefficients, domain=[0.0, h], window=[0.0, 1.0])
    rate = cubic.deriv()
    line = along(cubic(0.0) / factor, factor, end=cubic(h), before=rate(0.0), after=rate(h))
    moved = factor * Polynomial([start(line, h), slope(line, h)])
    t = 0.5 * h * (1.0 + np.polynomial.legendre.leggauss(4)[0])
    weights = np.polynomial.legendre.leggauss(4)[1]
    scale = 1e-9 * (1.0 + max(map(abs, coefficients)))
    for moment in (np.ones(4), t / h):
        assert weights @ (moment * (moved(t) - cubic(t))) == pytest.approx(0.0, abs=scale)


@given(values, values, steps, factors)
def test_without_derivatives_it_is_the_chord(begin, end, h, factor):
    line = along(begin, factor, end=end * factor)
    assert start(line, h) == begin
    assert begin + h * slope(line, h) == pytest.approx(end, abs=1e-9)


@given(values, values, steps)
def test_a_straight_signal_is_its_own_line(begin, rate, h):
    line = along(begin, end=begin + h * rate, before=rate, after=rate)
    assert start(line, h) == pytest.approx(begin, abs=1e-9)
    assert h * slope(line, h) == pytest.approx(h * rate, abs=1e-9)


@given(values, factors)
def test_where_the_end_is_not_known_it_follows_the_derivative(rate, factor):
    line = along(7.0, factor, before=rate)
    assert start(line, 1e-3) == 7.0
    assert slope(line, 1e-3) == rate / factor

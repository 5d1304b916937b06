"""Numbers in messages are written as Python writes them: the fewest digits that read back as the same number."""

import math
import sys

import pytest
from fmutesting.host import opened
from fmutesting.together import together
from hypothesis import given
from hypothesis import strategies as st

START = 0.3
"""Time in s; there is no power of two or ten near it."""

BORDERS = [
    *(0.0, -0.0, 1e16, 9999999999999998.0, 123456789012345680.0, 1e-4, 1e-5, 0.00012345, -1e22, 1e23, 0.1, 2.0 / 3.0),
    *(5e-324, -1e-310, sys.float_info.min, sys.float_info.max, math.nan, math.inf, -math.inf),
]


@pytest.fixture(scope="module")
def host(built, tmp_path_factory):
    """An instance that refuses to make a step from any other time than START."""
    with opened(built / "MotorTorqueLoop.fmu", tmp_path_factory.mktemp("numbers")) as host:
        host.initialize(start_time=START)
        yield host


def written(host, number):
    message = host.refuses(host.step, number, 0.001)
    return message.removeprefix("currentCommunicationPoint = ").partition(" s ")[0]


@together("number", BORDERS)
def test_a_number_at_a_border_is_written_as_in_python(host, number):
    assert written(host, number) == repr(number)


@given(number=st.floats(width=64).filter(lambda number: not abs(number - START) < 1e-5))
def test_any_number_is_written_as_in_python(host, number):
    assert written(host, number) == repr(number)


@together("base", [2.0, 10.0])
def test_every_power_is_written_as_in_python(host, base):
    """About a power of two the distance to the next number is not the same on both sides."""
    exponents = range(-1074, 1024) if base == 2.0 else range(-323, 309)
    powers = [math.ldexp(1.0, k) if base == 2.0 else float(f"1e{k}") for k in exponents]
    for power in powers:
        for number in (power, math.nextafter(power, 0.0), math.nextafter(power, math.inf)):
            assert written(host, number) == repr(number)

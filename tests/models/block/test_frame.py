"""What the bits of a frame hold."""

import pytest

from driveline.models.wheel_speed_can import Parameters
from fmublocks.block.frame import Content, Layout, count, layout

P = Parameters()
SPEED = Content("Speed", "v", "km/h", bits=4, resolution=lambda p: 0.5, factor=lambda p: 3.6, largest=lambda p: 7.5)
COUNTER = Content("Counter", "counter", "", bits=4)


def test_a_value_is_the_nearest_count_and_no_more_than_the_bits_hold() -> None:
    of = layout(SPEED, P)
    assert of == Layout(0.5, 4, 7.5)
    counts = {-1.0: 0, 0.0: 0, 0.0694: 0, 0.0695: 1, 2.0: 14, 7.5 / 3.6: 15, 100.0: 15}
    assert {value: count(SPEED, of, value, P) for value in counts} == counts


def test_a_counter_begins_again() -> None:
    of = layout(COUNTER, P)
    assert [count(COUNTER, of, value, P) for value in (0, 15, 16, 33)] == [0, 15, 0, 1]


@pytest.mark.parametrize(("largest", "bits"), [(7.5, 4), (7.7, 4), (7.8, 5), (8.0, 5)])
def test_there_are_as_many_bits_as_the_largest_value_takes(largest: float, bits: int) -> None:
    content = Content("Speed", "v", "km/h", bits=4, resolution=lambda p: 0.5, largest=lambda p: largest)
    assert layout(content, P).bits == bits


def test_more_than_32_bits_are_refused() -> None:
    content = Content("Speed", "v", "km/h", bits=4, resolution=lambda p: 1e-9, largest=lambda p: 10.0)
    with pytest.raises(ValueError, match="32 bits do not hold 10 km/h in such steps"):
        layout(content, P)

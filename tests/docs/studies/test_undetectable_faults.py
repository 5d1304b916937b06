"""Wrong motor speeds that no signal tells: what reaches the controller of them."""

from typing import NamedTuple

import pytest

from docs.studies.undetectable_faults import CASES, FAULTS, LATE, received


class Sent(NamedTuple):
    omega_1_meas: float


@pytest.mark.parametrize(("fault", "speed"), [*zip(FAULTS, (350.0, 75.0, 0.0, -150.0), strict=True)])
def test_a_wrong_speed_is_received_at_every_sample(fault: str, speed: float) -> None:
    assert received(fault)(1.0, Sent(150.0)) == Sent(speed)


def test_a_late_speed_is_that_of_62_ms_before() -> None:
    late, instants = received("late"), [0.002 * k for k in range(100)]
    seen = [late(t, Sent(t)).omega_1_meas for t in instants]
    assert seen[:32] == [0.0] * 32
    assert seen[32:] == pytest.approx([t - LATE for t in instants[32:]], abs=1e-12)


def test_every_fault_is_tried() -> None:
    assert {fault for _, fault in CASES} == {*FAULTS, "late"}

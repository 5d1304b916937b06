"""The page of the target, as far as it can be written without one."""

from driveline.harness.exchange.target.offline_results import Part
from driveline.harness.exchange.target.target_page import parts_table


def test_controllers_stand_to_the_left_and_what_they_take_to_the_right() -> None:
    _, aligned, row = parts_table([Part("SpeedWashout", 900, 4096)]).splitlines()
    assert [cell.strip().endswith(":") for cell in aligned.strip("| ").split("|")] == [False, True, True]
    assert [cell.strip() for cell in row.strip("| ").split("|")] == ["SpeedWashout", "900", "4096 B"]

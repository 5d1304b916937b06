"""Messages as samples of the controller."""

from driveline.harness.studies.margins.averaged_messages import messages
from driveline.harness.studies.margins.operating_point import Point


def test_messages_count_in_samples_of_two_milliseconds() -> None:
    """Between two and four milliseconds they come half a sample later on average."""
    found = messages(Point().with_parameters(can={"T_cyc": 0.02, "d_min": 0.002, "d_max": 0.004}))
    assert found == (10, 2)

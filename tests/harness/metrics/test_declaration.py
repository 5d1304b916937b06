"""What is declared of a metric is what everything that shows it says."""

from dataclasses import dataclass, fields
from typing import Annotated

import pytest

from driveline.harness.metrics.declaration import Column, Metric, declared
from driveline.harness.metrics.run_metrics import Metrics, RideMetrics


@dataclass
class Worth:
    impact_speed: Annotated[float, Metric("rad/s", "speed of the teeth")]
    share: Annotated[float, Metric("1", "of the whole")]


def test_a_metric_has_the_name_of_its_field_and_its_value():
    speed, share = declared(Worth)
    assert (speed.name, speed.unit, share.description) == ("impact_speed", "rad/s", "of the whole")
    assert (speed.of(Worth(2.0, 3.0)), share.of(Worth(2.0, 3.0))) == (2.0, 3.0)


def test_a_heading_is_joined_to_one_line():
    assert Column("im-\npact\nspeed", "rpm", 9.55, 1).plain_heading == "impact speed"


@pytest.mark.parametrize(
    ("unit", "key"),
    [("s", "x_s"), ("1", "x_1"), ("rad/s", "x_rad_per_s"), ("m/s3", "x_m_per_s3"), ("N.m", "x_N_m")],
)
def test_the_key_ends_in_the_unit_in_words(unit, key):
    assert Metric(unit, "", name="x").key == key


@pytest.mark.parametrize("record", [Metrics, RideMetrics])
def test_every_metric_is_declared_with_unit_and_meaning(record):
    metrics = declared(record)
    assert [metric.name for metric in metrics] == [field.name for field in fields(record) if field.name != "absent"]
    assert all(metric.unit and metric.description for metric in metrics)

"""What is declared of a metric is what everything that shows it says: tables in notebooks and frames with units."""

import math
import re
from dataclasses import dataclass, fields
from typing import Annotated, NamedTuple

import pytest

from driveline.harness.metrics.declaration import Column, Metric, declared
from driveline.harness.metrics.notebook_table import frame
from driveline.harness.metrics.run_metrics import Metrics, RideMetrics
from toolground.errors import UserError

RIDE = RideMetrics(2.0, math.nan, 4.0, 0.123456, {"gear_damage": "counts <nothing>"})


class Case(NamedTuple):
    k_d: float
    phi_B: float


def rows(record: object) -> list[str]:
    return re.findall(r"<tr title.*?</tr>", record._repr_html_())  # type: ignore[attr-defined]


def test_the_table_has_name_value_unit_meaning_and_the_reason_of_a_dash() -> None:
    every = declared(RideMetrics)
    assert len(rows(RIDE)) == len(every)
    torque = rows(RIDE)[0]
    assert torque.startswith(f'<tr title="{every[0].description}">')
    assert "<td>gear_torque_rms</td><td>2</td><td>N.m</td>" in torque
    assert "<td>speed_error_rms</td><td>0.1235</td><td>m/s</td>" in rows(RIDE)[-1]
    assert '<td title="counts &lt;nothing&gt;">-</td>' in rows(RIDE)[1]
    values = {metric.name: 0.5 for metric in declared(Metrics)}
    assert any("<td>overshoot</td><td>0.5</td><td></td>" in row for row in rows(Metrics(**values)))  # type: ignore[arg-type]


def test_a_frame_has_a_row_a_run_with_units_and_fields_as_levels_of_the_index() -> None:
    found = frame({"off": RIDE, "on": RideMetrics(1.0, 8.0, 3.0, 0.2)})
    assert list(found.index) == ["off", "on"]
    assert list(found.gear_torque_rms) == [2.0, 1.0]
    assert math.isnan(found.gear_damage["off"])
    assert found.attrs["units"] == {metric.name: metric.unit for metric in declared(RideMetrics)}
    assert "absent" not in found
    found = frame({Case(k_d, phi_B): RIDE for k_d in (1.0, 2.0) for phi_B in (0.1, 0.2, 0.3)})
    assert found.index.names == ["k_d", "phi_B"]
    assert found["jerk_rms"].unstack("phi_B").shape == (2, 3)
    assert frame({Case(1.0, 0.1): RIDE}).index.names == ["k_d", "phi_B"]
    with pytest.raises(UserError, match="there are no runs"):
        frame({})


@dataclass
class Worth:
    impact_speed: Annotated[float, Metric("rad/s", "speed of the teeth")]
    share: Annotated[float, Metric("1", "of the whole")]


def test_a_metric_has_the_name_of_its_field_its_value_and_a_heading_in_one_line():
    speed, share = declared(Worth)
    assert (speed.name, speed.unit, share.description) == ("impact_speed", "rad/s", "of the whole")
    assert (speed.of(Worth(2.0, 3.0)), share.of(Worth(2.0, 3.0))) == (2.0, 3.0)
    assert Column("im-\npact\nspeed", "rpm", 9.55, 1).plain_heading == "impact speed"


@pytest.mark.parametrize(
    ("unit", "key"), [("s", "x_s"), ("1", "x_1"), ("rad/s", "x_rad_per_s"), ("m/s3", "x_m_per_s3"), ("N.m", "x_N_m")]
)
def test_the_key_ends_in_the_unit_in_words(unit, key):
    assert Metric(unit, "", name="x").key == key


@pytest.mark.parametrize("record", [Metrics, RideMetrics])
def test_every_metric_is_declared_with_unit_and_meaning(record):
    metrics = declared(record)
    assert [metric.name for metric in metrics] == [field.name for field in fields(record) if field.name != "absent"]
    assert all(metric.unit and metric.description for metric in metrics)

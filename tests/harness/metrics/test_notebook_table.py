"""Metrics in a notebook: what each means, why one has no value, and frames with units."""

import math
import re
from typing import NamedTuple

import pytest

from driveline.harness.base.errors import DrivelineError
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.notebook_table import frame
from driveline.harness.metrics.run_metrics import Metrics, RideMetrics

RIDE = RideMetrics(2.0, math.nan, 4.0, 0.123456, {"gear_damage": "counts <nothing>"})


class Case(NamedTuple):
    k_d: float
    phi_B: float


def rows(record: object) -> list[str]:
    return re.findall(r"<tr title.*?</tr>", record._repr_html_())  # type: ignore[attr-defined]


def test_the_table_has_name_value_and_si_unit_of_each_metric_and_its_meaning_under_the_pointer() -> None:
    every = declared(RideMetrics)
    assert len(rows(RIDE)) == len(every)
    torque = rows(RIDE)[0]
    assert torque.startswith(f'<tr title="{every[0].description}">')
    assert "<td>gear_torque_rms</td><td>2</td><td>N.m</td>" in torque
    assert "<td>speed_error_rms</td><td>0.1235</td><td>m/s</td>" in rows(RIDE)[-1]


def test_a_metric_without_value_is_a_dash_with_the_reason_whatever_is_in_it() -> None:
    assert '<td title="counts &lt;nothing&gt;">-</td>' in rows(RIDE)[1]


def test_a_share_has_no_unit() -> None:
    values = {metric.name: 0.5 for metric in declared(Metrics)}
    assert any("<td>overshoot</td><td>0.5</td><td></td>" in row for row in rows(Metrics(**values)))  # type: ignore[arg-type]


def test_a_frame_has_a_row_a_run_and_the_units() -> None:
    found = frame({"off": RIDE, "on": RideMetrics(1.0, 8.0, 3.0, 0.2)})
    assert list(found.index) == ["off", "on"]
    assert list(found.gear_torque_rms) == [2.0, 1.0]
    assert math.isnan(found.gear_damage["off"])
    assert found.attrs["units"] == {metric.name: metric.unit for metric in declared(RideMetrics)}
    assert "absent" not in found


def test_cases_with_named_fields_become_levels_of_the_index() -> None:
    found = frame({Case(k_d, phi_B): RIDE for k_d in (1.0, 2.0) for phi_B in (0.1, 0.2, 0.3)})
    assert found.index.names == ["k_d", "phi_B"]
    assert found["jerk_rms"].unstack("phi_B").shape == (2, 3)


def test_a_frame_of_nothing_is_refused() -> None:
    with pytest.raises(DrivelineError, match="there are no runs"):
        frame({})

"""The tables of what the loop asks of FMUs are those of the code."""

import re

from docs.site.declared import further_variables, loop_variables
from driveline.harness.metrics.evaluate import COLUMNS
from driveline.harness.studies.drives.replay import KEPT


def test_what_is_measured_of_a_run_needs_no_more_than_the_loop_exchanges() -> None:
    rows = [line.split("|")[1:] for line in loop_variables().splitlines()[2:]]
    exchanged = {f"{place.strip(' `')}.{name}" for place, *cells in rows for name in re.findall(r"`(\w+)`", str(cells))}
    assert {*COLUMNS, *KEPT} - {"time"} <= exchanged
    assert "controller.enable" in exchanged
    further = set(re.findall(r"`(\w+\.\w+)`", further_variables()))
    assert {"plant.T_rim", "controller.T_gear_hat", "controller.status", "plant.c_wa"} <= further
    assert not further & exchanged

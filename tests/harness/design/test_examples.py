"""Each car of examples/cars is designed, driven, and damped."""

from pathlib import Path

import pytest

from docs.studies.design_trials import Gains, Trial, measured
from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import Settings
from tests import ROOT


@pytest.mark.slow
@pytest.mark.parametrize("path", sorted((ROOT / "examples" / "cars").glob("*.toml")), ids=lambda path: path.stem)
def test_a_tip_in_settles_in_less_than_half_the_time_with_less_than_a_third_of_the_overshoot(
    path: Path, native: Path
) -> None:
    for plant in PLANTS:
        off, on = (
            measured(Trial(path, plant, "tipin15", gains), (1,), Settings(folder=native.parent, build="native"))
            for gains in (Gains.NONE, Gains.OWN)
        )
        assert on.settling_time < 0.5 * off.settling_time, plant
        assert on.overshoot < off.overshoot / 3.0, plant

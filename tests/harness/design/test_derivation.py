"""docs/control.md says the values that the code has."""

import re
from math import atan, degrees, pi, sqrt

import pytest

from driveline.harness.design.design_weights import CAN, MOTOR, PLANT, WEIGHTS, drive_train
from driveline.models.controller import T_S, damping_law, torque_estimator
from tests import ROOT

PAGE = (ROOT / "docs" / "control.md").read_text(encoding="utf-8")

LAW, OBSERVER = damping_law.Parameters(), torque_estimator.Parameters()
DECLARED = OBSERVER._asdict() | LAW._asdict()
TRAIN = drive_train(PLANT, MOTOR, CAN)
CROSSOVER = LAW.k_d / LAW.J_1


def test_values_are_those_of_the_default_car() -> None:
    documented = re.findall(
        r"\(`(\w+)`, ([\d.]+)( ms)?|`(\w+)` \(([\d.]+)\)", PAGE.partition("## Signals that fail")[0]
    )
    values = {
        name or other: float(value or plain) * (1e-3 if ms else 1.0) for name, value, ms, other, plain in documented
    }
    assert values.pop("wheel_share") == pytest.approx(WEIGHTS.wheel_share, abs=0.005)
    assert len(values) >= 9
    assert values == pytest.approx({name: DECLARED[name] for name in values})


@pytest.mark.parametrize(
    ("text", "value"),
    [
        (r"vehicle, \$M = m r\^2/i\^2\$ of ([\d.]+) kg", TRAIN.M),
        (r"\$\\sqrt\{C/J_1 \+ C/J_2\}\$ \(([\d.]+) Hz\)", sqrt(PLANT.C / PLANT.J_1 + PLANT.C / PLANT.J_2) / (2 * pi)),
        (r"delay of \$\\sqrt2 \\tau\$ \(([\d.]+) ms\)", 1e3 * sqrt(2.0) * MOTOR.tau),
        (r"\(([\d.]+) rad/s\)\nthe model in contact", TRAIN.omega_0),
        (r"which is ([\d.]+) for \$k_d\$", CROSSOVER / (2.0 * TRAIN.omega_0)),
        (r"for \$k_d\$ of ([\d.]+) N", LAW.k_d),
        (r"for the hold, the rest for the motor; ([\d.]+) ms", 1e3 * TRAIN.T_dead),
        (r"\$T_\\mathrm\{dead\} k_d/J_1\$ \(([\d.]+) rad\)", TRAIN.T_dead * CROSSOVER),
        (r"which is ([\d.]+) Hz; the margins", (CROSSOVER / 2 + sqrt(CROSSOVER**2 / 4 + TRAIN.omega_0**2)) / (2 * pi)),
        (r"a phase of ([\d.]+) degrees", degrees(atan(LAW.omega_w / TRAIN.omega_0))),
        (r"over the whole gap make ([\d.]+) rad/s", sqrt(2.0 * 100.0 * 2.0 * OBSERVER.phi_B / LAW.J_1)),
        (r"rad/s, and ([\d.]+) N·m of twist", sqrt(2.0 * 100.0 * 2.0 * OBSERVER.phi_B * LAW.C)),
        (r"\$\\mathrm\{lead\}/\\omega_\\mathrm\{slow\}\$ \(([\d.]+) ms\)", 1e3 * LAW.demand_lead / LAW.omega_slow),
        (r"\$h = T_s\$ of ([\d.]+) ms", 1e3 * T_S),
    ],
)
def test_what_follows_is_computed_from_them(text: str, value: float) -> None:
    (documented,) = re.findall(text, PAGE)
    decimals = len(documented.partition(".")[2])
    assert documented == f"{value:.{decimals}f}"

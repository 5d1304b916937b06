"""Units as FMUs write them: by what factor they convert, and which do not."""

from math import pi

import pytest

from toolground.unit_conversion import LONGEST, SI, factor, known, quantity


@pytest.mark.parametrize(
    ("unit", "target_unit", "expected"),
    [
        ("N.mm", "N.m", 1e-3),
        ("kN.m", "N.m", 1e3),
        ("Nm", "N.m", 1.0),
        ("N*m", "N.m", 1.0),
        ("J", "N.m", 1.0),
        ("rpm", "rad/s", pi / 30.0),
        ("rev/min", "rad/s", pi / 30.0),
        ("1/min", "rad/s", pi / 30.0),
        ("deg/s", "rad/s", pi / 180.0),
        ("deg", "rad", pi / 180.0),
        ("rev", "rad", 2.0 * pi),
        ("km/h", "m/s", 1.0 / 3.6),
        ("cm/s2", "m/s2", 1e-2),
        ("m.s-2", "m/s2", 1.0),
        ("m/s^2", "m/s2", 1.0),
        ("%", "1", 1e-2),
        ("N.m/deg", "N.m/rad", 180.0 / pi),
        ("g.cm2", SI, 1e-7),
        ("kJ/(kg.K)", SI, 1e3),
        ("N.m.s/rad", SI, 1.0),
        ("Nms/rad", "N.m.s/rad", 1.0),
        ("N.m/(rad/s)", "N.m.s/rad", 1.0),
        ("Nm/(deg/s)", "N.m.s/rad", 180.0 / pi),
        ("Nm/rad", "N.m/rad", 1.0),
        ("kgm2", "kg.m2", 1.0),
        ("kg m^2", "kg.m2", 1.0),
        ("kg·m²", "kg.m2", 1.0),
        ("U/min", "rad/s", pi / 30.0),
        ("min^-1", "rad/s", pi / 30.0),
        ("°/s", "rad/s", pi / 180.0),
        ("kmh", "m/s", 1.0 / 3.6),
        ("mph", "m/s", 0.44704),
        ("N·m", "N.m", 1.0),
        ("N m", "N.m", 1.0),
        ("N-m", "N.m", 1.0),
        ("kNm", "N.m", 1e3),
        ("g", "m/s2", 9.80665),
        ("g", "kg", 1e-3),
        ("m/s²", "m/s2", 1.0),
        ("m/s**2", "m/s2", 1.0),
        ("-", "1", 1.0),
        ("ms", "s", 1e-3),
        ("µs", "s", 1e-6),
        ("\u03bcs", "s", 1e-6),
        ("Grad", "rad", pi / 180.0),
        ("KM/H", "m/s", 1.0 / 3.6),
        ("M/S", "m/s", 1.0),
        ("NM", "N.m", 1.0),
        ("nm", "N.m", 1.0),
        ("nm", "m", 1e-9),
        ("MS", "s", 1e-3),
        ("Ms", "s", 1e6),
        ("lb-ft", "N.m", 1.3558179483314),
        ("LB-FT", "N.m", 1.3558179483314),
        ("ft-lb", "N.m", 1.3558179483314),
        ("lbf.ft", "N.m", 1.3558179483314),
        ("in-lbs", "N.m", 0.112984829027617),
    ],
)
def test_a_unit_converts_by_its_factor(unit, target_unit, expected):
    assert factor(unit, target_unit) == pytest.approx(expected, rel=1e-12)
    assert known(unit)


@pytest.mark.parametrize("unit", ["N.m", "parsec", "whatever it is called"])
def test_the_same_unit_needs_no_factor_whether_it_is_known_or_not(unit):
    assert factor(unit, unit) == 1.0


def test_a_unit_may_have_exponents_of_one_digit_and_sixty_characters():
    assert factor("h9.min-9.N.m", "N.m") == pytest.approx(60.0**9, rel=1e-14)
    longest, longer = (f"mm{short * '.m.m-1'}{long * '.m.m^-1'}" for short, long in ((5, 4), (4, 5)))
    assert (len(longest), len(longer)) == (LONGEST, LONGEST + 1)
    assert factor(longest, "m") == pytest.approx(1e-3)
    with pytest.raises(ValueError, match="not a known unit"):
        factor(longer, "m")


@pytest.mark.parametrize(
    ("unit", "target_unit", "reason"),
    [
        ("rad", "N.m", "is in rad, which does not convert into N.m"),
        # per second may be a frequency or an angular speed, and a stiffness is no torque
        ("1/s", "rad/s", "does not convert into rad/s"),
        ("Hz", "rad/s", "does not convert into rad/s"),
        ("N.m/rad", "N.m", "does not convert into N.m"),
        ("degC", SI, "is in degC, which has an offset"),
        ("furlong per fortnight", "m/s", "'furlong per fortnight', which is not a known unit"),
        ("Umin", "rad/s", "'Umin', which is not a known unit"),
        ("J/kg.K", SI, "'J/kg.K', which is not a known unit"),
        ("import", "m", "'import', which is not a known unit"),
        ("", "m", "'', which is not a known unit"),
        ("quux", "s", "'quux', which is not a known unit"),
        ("m0", "m", "'m0', which is not a known unit"),
        ("m**9", "m", "which does not convert into m"),
        # what would take for ever, or is larger than any number
        ("h200.min-200.N.m", "N.m", "'h200.min-200.N.m', which is not a known unit"),
        ("h99999999.min-99999999", "1", "which is not a known unit"),
        (".".join(["m", *["m.m-1"] * 3000]), "m", r"(m.m-1)+.*characters\)', which is not a known unit"),
        (".".join(["Ys9"] * 14) + ".s", SI, "whose factor to SI is larger or smaller than a number can be"),
        (".".join(["ys9"] * 14) + ".s", SI, "whose factor to SI is larger or smaller than a number can be"),
    ],
)
def test_what_does_not_convert_is_refused_by_name(unit, target_unit, reason):
    with pytest.raises(ValueError, match=reason):
        factor(unit, target_unit)


@pytest.mark.parametrize("text", ["12000 1/min", "12000 rpm", "12000rpm", "1.2e4U/min"])
def test_a_unit_follows_its_number_and_begins_with_a_digit_after_a_blank_alone(text):
    assert quantity(text, "rad/s") == pytest.approx(400.0 * pi)
    assert quantity("9.3:1", "1") == 9.3
    with pytest.raises(ValueError, match="must be a number and a unit"):
        quantity("120001", "rad/s")

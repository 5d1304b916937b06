"""What Python says and allows, as C gets it."""

from driveline.fmus.native.shared_header import definition, shared_header
from tests.together import together


@together(
    "value, text",
    [
        (1e-13, "#define X 1e-13"),
        (16, "#define X 16"),
        (("in one", 'in "two"'), r'#define X {"in one", "in \"two\""}'),
        ("nothing to fill in", '#define X "nothing to fill in"'),
        ("{b!r} of {a} is 5 % of {a}", '#define X(b, a) "%s of %s is 5 %% of %s", b, a, a'),
        ("{k:d} is above {most:g}", '#define X(k, most) "%u is above %g", k, most'),
        ({"not": "for C"}, ""),
    ],
)
def test_a_value_becomes_a_macro_and_its_fields_the_parameters(value, text):
    assert definition("X", value) == text


def test_what_a_number_means_is_said_in_c_too():
    text = shared_header()
    assert "/* Time in s over which the slope of an event indicator is taken. */\n#define PROBE 1e-07\n" in text
    assert "/* In s: how far the host's time may be from the FMU's. */\n#define TIME_TOLERANCE 1e-06\n" in text
    assert "#define TICK_TOLERANCE 0.001\n" in text

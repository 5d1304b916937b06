"""The manoeuvres are exactly those of the specification."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from docs.studies import town_drive
from driveline.harness.manoeuvres.catalogue import COMPARED, EVERYDAY, MANOEUVRES, TOWN_DRIVE, USUAL_MANOEUVRES
from driveline.harness.manoeuvres.prbs import shift_register
from driveline.harness.manoeuvres.signals import FlatSine, Held, lines
from driverecords.drive import read_drive


@pytest.mark.parametrize(
    ("name", "before", "after"),
    [("tipin15", -12, 100), ("tipin50", -12, 100), ("tipin0", 20, 100), ("tipout", 100, -30)],
)
def test_a_step_has_its_new_value_at_one_second_and_the_old_one_before(name, before, after):
    manoeuvre = MANOEUVRES[name]
    T = manoeuvre.T_driver(np.array([0.0, 0.999, 1.0, 1.001, 6.0]))
    assert T.tolist() == [before, before, after, after, after]
    assert (manoeuvre.T_0, manoeuvre.dT) == (before, after - before)


@given(st.sampled_from([1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3]))
def test_a_step_comes_at_the_same_sample_whatever_the_rounding_of_time(step_size):
    products = np.arange(round(2.0 / step_size)) * step_size
    sums = np.cumsum(np.full(len(products), step_size)) - step_size
    expected = np.where(np.arange(len(products)) >= round(1.0 / step_size), 100.0, -12.0)
    for t in (products, sums):
        np.testing.assert_array_equal(MANOEUVRES["tipin15"].T_driver(t), expected)


def test_ramps_rise_or_reverse_the_torque_within_their_time():
    assert MANOEUVRES["tipin50r"].T_driver([1.0, 1.075, 1.15, 2.0]) == pytest.approx([-12, 44, 100, 100])
    assert MANOEUVRES["launch"].T_driver([0.0, 1.0, 1.05, 1.1, 6.0]) == pytest.approx([0, 0, 60, 120, 120])
    for name, halfway in {"regen": -60.0, "regenr": 0.0}.items():
        T = MANOEUVRES[name].T_driver(np.array([0.999, 1.1, 1.2]))
        assert pytest.approx([60.0, halfway, -60.0], abs=1e-9) == T, name


def test_the_drive_brakes_at_the_end_and_has_plateaus():
    drive = MANOEUVRES["drive"]
    assert drive.T_brake([0.0, 16.2, 16.4, 16.6, 20.0]) == pytest.approx([0, 0, 650, 1300, 1300])
    assert drive.T_driver([0.6, 4.55, 16.15, 20.0]) == pytest.approx([56, 53.5, 10.5, -24])
    for end in drive.plateau_ends:
        assert np.ptp(drive.T_driver(np.linspace(end - 0.45, end, 50))) == 0.0
        assert drive.T_driver(end + 0.05) != drive.T_driver(end)


def test_the_binary_sequence_is_as_specified_and_each_bit_held_for_40_ms():
    bits = shift_register(1022)
    assert bits[:19] == [1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 1, 1, 1, 1, 0]
    assert bits[:511] == bits[511:]
    assert sum(bits[:511]) == 256
    T = MANOEUVRES["prbs"].T_driver(np.arange(10_000) * 1e-3)
    np.testing.assert_array_equal(T, np.repeat(8.0 + 15.0 * (2.0 * np.array(shift_register(250)) - 1.0), 40))


def test_creep_floats_and_brakes_pulse() -> None:
    T = MANOEUVRES["creep"].T_driver(np.arange(12_000) * 1e-3)
    assert T[0] == 7.0
    assert (T.min(), T.max()) == (-8.0, 22.0)
    t = np.arange(4000) * 1e-3
    T_brake = MANOEUVRES["abs"].T_brake(t)
    assert set(T_brake.tolist()) == {200.0, 3500.0}
    assert np.diff(t[1:][np.diff(T_brake) > 0.0]) == pytest.approx(0.2)


@pytest.mark.parametrize("manoeuvre", MANOEUVRES.values(), ids=lambda m: m.name)
def test_signals_are_finite_and_brakes_never_push(manoeuvre):
    t = np.arange(round(manoeuvre.duration / 1e-3) + 1) * 1e-3
    for signal in (manoeuvre.T_driver, manoeuvre.T_brake, manoeuvre.slope):
        assert signal(t).shape == t.shape
        assert np.isfinite(signal(t)).all()
    assert (manoeuvre.T_brake(t) >= 0.0).all()
    assert np.abs(manoeuvre.T_driver(t)).max() <= 180.0


def test_which_are_compared_everyday_and_slippery() -> None:
    assert COMPARED == (
        "tipin15", "tipin50", "tipin15r", "tipin50r", "tipin0", "tipout", "launch", "drive", "creep", "prbs"
    )  # fmt: skip
    assert list(MANOEUVRES) == [each.name for each in (*USUAL_MANOEUVRES, *EVERYDAY)]
    assert len(USUAL_MANOEUVRES) == 13
    assert {"regen", "one_pedal_hard", "blending", "hill_start", "park_back", "abs"} <= {each.name for each in EVERYDAY}
    assert not {each.name for each in EVERYDAY} & set(COMPARED)
    found = {name: dict(each.road) for name, each in MANOEUVRES.items() if each.road}
    assert found == {"launch_ice": {"mu": 0.12}, "launch_split": {"g_muL": 0.12}, "ice_hill": {"mu": 0.12}}


def test_signals_are_held_beyond_their_ends():
    ramp, held = lines((1.0, 2.0), (3.0, 4.0)), Held(0.5, np.array([1.0, 2.0]))
    assert ramp([-1.0, 9.0]).tolist() == [2.0, 4.0]
    assert held([-1.0, 0.49, 0.5, 9.0]).tolist() == [1.0, 1.0, 2.0, 2.0]


@pytest.mark.parametrize("frequency", [0.5, 8.0])
def test_a_flat_sine_has_its_period_its_flanks_and_its_amplitude(frequency: float) -> None:
    signal = FlatSine(mean=3.0, amplitude=10.0, frequency=frequency, steepness=2.0)
    t = np.linspace(0.0, 1.0 / frequency, 401)
    np.testing.assert_allclose(signal(t + 1.0 / frequency), signal(t), atol=1e-9)
    np.testing.assert_allclose(signal(t[:200] + 0.5 / frequency) - 3.0, 3.0 - signal(t[:200]), atol=1e-9)
    assert (signal(t).min(), signal(t).max()) == (-7.0, 13.0)
    assert signal(np.array([1.0 / 24.0 / frequency])) == pytest.approx(3.0 + 20.0 * np.sin(np.pi / 12.0))


def test_the_bundled_drive_is_that_of_its_script_with_stops_and_zero_torque(tmp_path):
    town_drive.write(tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_bytes() == TOWN_DRIVE.read_bytes()
    recording = read_drive(TOWN_DRIVE)
    moving = recording.v > 0.0
    starts = np.flatnonzero(moving[1:] & ~moving[:-1])
    stops = np.flatnonzero(~moving[1:] & moving[:-1])
    assert (len(starts), len(stops)) == (2, 2)
    crossings = np.flatnonzero(np.diff(np.sign(recording.T_mot[moving])))
    assert len(crossings) > 10

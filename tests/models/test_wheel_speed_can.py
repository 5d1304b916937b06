"""The wheel speed on the bus: right when stationary, late, coarse, absent at low speed."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import pytest

from driveline.models import wheel_speed_can as can
from driveline.models.physics import tooth_wheel

P = can.Parameters()
EXACT = P._replace(q_v=0.0, sigma_tooth=0.0)
PITCH = tooth_wheel.PITCH
SIDE = P.r / P.i
"""From the motor side in rad/s to m/s."""


class Run(NamedTuple):
    """One entry every millisecond: time, received speed (rad/s, motor side), validity, counter."""

    t: np.ndarray
    omega: np.ndarray
    valid: np.ndarray
    counter: np.ndarray

    def arrivals(self) -> np.ndarray:
        """Indices at which a message has just arrived."""
        return np.flatnonzero(np.diff(self.counter)) + 1


def run(wheels: Callable[[float], tuple[float, float]], seconds: float, p: can.Parameters = P) -> Run:
    """The block with the wheel speeds (rad/s) of each instant."""
    rows = []
    x = can.start(can.Input(*wheels(0.0)), p)
    for k in range(round(seconds / can.T_S)):
        u = can.Input(*wheels(k * can.T_S))
        rows.append((k * can.T_S, *can.output(x, u, p)))
        x = can.update(x, u, p)
    return Run(*np.array(rows, dtype=float).T)


def rolling(v: float) -> Callable[[float], tuple[float, float]]:
    """Both wheels at a constant speed in m/s."""
    return lambda t: (v / P.r, v / P.r)


RATE = 20.0


def ramp(t: float) -> tuple[float, float]:
    """Wheels that gain RATE rad/s every second."""
    return 60.0 + RATE * t, 60.0 + RATE * t


@pytest.mark.parametrize("v", [1.5, 4.0, 13.9, 40.0])
def test_a_constant_speed_is_measured_exactly_by_even_teeth(v: float) -> None:
    received = run(rolling(v), 2.0, EXACT).omega
    assert received == pytest.approx(np.full(2000, v / SIDE), rel=1e-9)


@pytest.mark.parametrize("v", [4.0, 13.9])
def test_resolution_and_tooth_errors_bound_the_error(v: float) -> None:
    """Half a step of the bus, and the errors of two edges (6.2 deviations at most) over a cycle."""
    error = np.abs(run(rolling(v), 4.0).omega * SIDE - v)
    teeth = 2.0 * 6.2 * P.sigma_tooth * PITCH * P.r / P.T_cyc
    assert 0.0 < error.max() < 0.5 * P.q_v + 1.2 * teeth


def test_each_wheel_is_rounded_by_itself() -> None:
    """So that the mean comes in halves of the resolution."""
    wheels = ((10.0 * P.q_v + 0.01 * P.q_v) / P.r, (301.2 * P.q_v) / P.r)
    received = run(lambda t: wheels, 1.0, P._replace(sigma_tooth=0.0)).omega[-1] * SIDE
    assert received == pytest.approx(0.5 * (10.0 + 301.0) * P.q_v)


@pytest.mark.parametrize(("T_cyc", "low", "high"), [(0.02, 0.011, 0.035), (0.01, 0.006, 0.030)])
def test_the_age_on_arrival_is_half_a_cycle_and_the_transport(T_cyc: float, low: float, high: float) -> None:
    """Read from a ramp: a message shows the speed of its age ago. On average 23 ms at 20 ms cycle.

    The teeth add at most half their spacing (0.7 ms here) to single messages.
    """
    seen = run(ramp, 8.0, EXACT._replace(T_cyc=T_cyc))
    at = seen.arrivals()[3:]
    age = seen.t[at] - (seen.omega[at] / P.i - 60.0) / RATE
    assert low - 0.001 < age.min() < low + 0.004
    assert high - 0.004 < age.max() < high + 0.003
    assert age.mean() == pytest.approx(0.5 * (low + high), abs=0.0015)


def test_messages_never_overtake_and_each_arrival_counts() -> None:
    """The speed rises, so that an older message would show as a fall; 10 ms cycle, 25 ms transport."""
    seen = run(ramp, 8.0, EXACT._replace(T_cyc=0.01))
    assert (np.diff(seen.omega) >= 0.0).all()
    steps = np.diff(seen.counter)
    assert set(steps) <= {0.0, 1.0, 2.0, 3.0}
    assert (np.diff(seen.omega)[steps == 0.0] == 0.0).all()
    assert (np.diff(seen.omega)[steps > 0.0] > 0.0)[3:].all()
    assert seen.counter[-1] == pytest.approx(8.0 / 0.01, abs=4.0)


def test_lost_messages_do_not_arrive() -> None:
    assert run(rolling(10.0), 20.0, P._replace(loss=0.3)).counter[-1] == pytest.approx(700.0, abs=60.0)
    assert run(rolling(10.0), 1.0, P._replace(loss=1.0)).counter[-1] == 0.0


def test_validity_has_a_hysteresis() -> None:
    """Up and down in 20 s: valid above 5 km/h, until below 3 km/h; messages are at most 35 ms old."""

    def triangle(t: float) -> tuple[float, float]:
        v = 2.0 * (1.0 - abs(t / 10.0 - 1.0))
        return v / P.r, v / P.r

    seen = run(triangle, 20.0)
    on, off = np.flatnonzero(np.diff(seen.valid)) + 1
    assert seen.valid[0] == seen.valid[-1] == 0.0
    assert seen.omega[on] * SIDE > P.v_on >= seen.omega[on - 1] * SIDE
    assert seen.omega[off] * SIDE < P.v_off <= seen.omega[off - 1] * SIDE
    assert triangle(seen.t[on])[0] * P.r == pytest.approx(P.v_on, abs=0.1)
    assert triangle(seen.t[off])[0] * P.r == pytest.approx(P.v_off, abs=0.1)


def test_the_sensor_cannot_tell_the_direction() -> None:
    forwards, backwards = run(rolling(5.0), 1.0), run(rolling(-5.0), 1.0)
    assert backwards.omega == pytest.approx(forwards.omega, abs=0.5 / SIDE)
    assert (backwards.omega > 0.0).all()


def test_at_a_sudden_stop_the_speed_decays_as_one_tooth_over_the_time() -> None:
    seen = run(lambda t: (10.0, 10.0) if t < 0.5 else (0.0, 0.0), 4.0, EXACT)
    for t in (1.0, 2.0, 3.9):
        bound = P.i * PITCH / (t - 0.5)
        assert seen.omega[round(t / can.T_S)] == pytest.approx(bound, rel=0.12)
    assert not seen.valid[-1]


def test_standing_still_from_the_start_gives_zero() -> None:
    seen = run(rolling(0.0), 1.0)
    assert not seen.omega.any()
    assert not seen.valid.any()
    assert seen.counter[-1] > 45


def edges(n: int) -> Iterator[float]:
    return (tooth_wheel.edge_position(float(k), can.TOOTH_L, P) - k for k in range(-n, n))


def test_tooth_errors_come_back_every_turn() -> None:
    errors = np.array(list(edges(96))).reshape(4, 48)
    assert errors == pytest.approx(np.tile(errors[0], (4, 1)), abs=1e-12)
    assert errors[0].std() == pytest.approx(P.sigma_tooth, rel=0.35)
    assert len(set(errors[0].round(9))) == 48


def test_the_gain_error_scales_the_speed() -> None:
    scaled = run(rolling(10.0), 0.5, P._replace(g_w2=1.02)).omega
    assert scaled == pytest.approx(1.02 * run(rolling(10.0), 0.5).omega)

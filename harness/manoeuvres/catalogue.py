"""The manoeuvres that the loop is driven through, by name."""

from dataclasses import replace
from math import atan
from pathlib import Path

from toolground.known_names import ByName

from .demand_shape import plateau_ends
from .manoeuvre import Manoeuvre
from .prbs import binary_torque
from .signals import FlatSine, lines

KMH = 1.0 / 3.6


def step(name: str, description: str, v_0: float, before: float, after: float, rise: float = 0.0) -> Manoeuvre:
    """The demand goes from one torque (N.m) to another at 1 s, in a jump or within `rise` seconds."""
    demand = lines((0.0, before), (1.0, before), (1.0 + rise, after))
    return Manoeuvre(name, description, 6.0, v_0, demand, t_0=1.0, dT=after - before)


def parking(name: str, description: str, way: float) -> Manoeuvre:
    """Released and held by the brakes twice, with a little torque in between; way: 1 forwards, -1 backwards."""
    T = 25.0 * way
    demand = ((0.5, 0.0), (0.7, T), (1.7, T), (1.9, 0.0), (4.0, 0.0), (4.2, T), (5.2, T), (5.4, 0.0))
    brake = ((0.4, 800.0), (0.6, 0.0), (2.2, 0.0), (2.6, 800.0), (3.9, 800.0), (4.1, 0.0), (5.7, 0.0), (6.1, 800.0))
    return Manoeuvre(name, description, 8.0, 0.0, lines(*demand), lines(*brake), t_0=0.4)


def brake_pulse(begin: float, end: float) -> tuple[tuple[float, float], ...]:
    """Corners of a pulse beyond what a dry road can take, above a brake torque that it can."""
    return (begin, 200.0), (begin, 3500.0), (end, 3500.0), (end, 200.0)


DRIVE = lines(
    (0.0, 12.0), (0.5, 12.0), (0.7, 100.0), (2.0, 100.0), (2.2, 30.0), (3.2, 30.0), (3.3, 125.0),
    (4.5, 125.0), (4.6, -18.0), (5.6, -18.0), (5.8, 80.0), (7.0, 80.0), (7.1, 12.0), (8.0, 12.0),
    (8.2, 110.0), (9.4, 110.0), (9.5, -24.0), (10.6, -24.0), (10.7, 70.0), (12.0, 70.0), (12.2, 130.0),
    (13.2, 130.0), (13.3, -28.0), (14.5, -28.0), (14.8, 45.0), (16.0, 45.0), (16.3, -24.0), (20.0, -24.0),
)  # fmt: skip

_PRBS = binary_torque("prbs", mean=8.0, amplitude=15.0, clock=0.04, order=9, duration=10.0, v_0=15 * KMH)

USUAL_MANOEUVRES = (
    step("tipin15", "tip-in through the backlash at 15 km/h", 15 * KMH, -12.0, 100.0),
    step("tipin50", "tip-in through the backlash at 50 km/h", 50 * KMH, -12.0, 100.0),
    step("tipin15r", "tip-in through the backlash at 15 km/h in 150 ms", 15 * KMH, -12.0, 100.0, 0.15),
    step("tipin50r", "tip-in through the backlash at 50 km/h in 150 ms", 50 * KMH, -12.0, 100.0, 0.15),
    step("tipin0", "tip-in at 15 km/h with the teeth in contact", 15 * KMH, 20.0, 100.0),
    step("tipout", "let go of the pedal at 50 km/h", 50 * KMH, 100.0, -30.0),
    step("launch", "pull away from standstill within 100 ms", 0.0, 0.0, 120.0, 0.1),
    Manoeuvre(
        name="drive",
        description="uneven driving that ends under the brakes, as on the paper's test track",
        duration=20.0,
        v_0=3.0,
        T_driver=DRIVE,
        T_brake=lines((16.2, 0.0), (16.6, 1300.0)),
        t_0=0.3,
        plateau_ends=plateau_ends(DRIVE),
    ),
    Manoeuvre(
        name="creep",
        description="the gear floats through zero torque at 15 km/h",
        duration=12.0,
        v_0=15 * KMH,
        T_driver=FlatSine(mean=7.0, amplitude=15.0, frequency=0.45, steepness=4.0),
    ),
    _PRBS,
    replace(_PRBS, name="prbs15", description="the first 5 s of prbs", duration=5.0),
    Manoeuvre(
        name="launch_brake",
        description="pull away, cross a 5 % hump and brake to a stop",
        duration=10.0,
        v_0=0.0,
        T_driver=lines((0.5, 0.0), (0.6, 120.0), (4.0, 120.0), (4.2, 0.0)),
        T_brake=lines((5.0, 0.0), (5.3, 1500.0), (9.5, 1500.0), (9.6, 0.0)),
        slope=lines((2.0, 0.0), (2.5, 0.05), (3.5, 0.05), (4.0, 0.0)),
    ),
    Manoeuvre(
        name="hill_hold",
        description="stand on a 10 % grade under the brakes, then pull away uphill",
        duration=6.0,
        v_0=0.0,
        T_driver=lines((3.0, 0.0), (3.4, 90.0)),
        T_brake=lines((3.0, 1500.0), (3.3, 0.0)),
        slope=lines((0.2, 0.0), (0.7, 0.10)),
    ),
)
"""Those that the studies drive through; where they say every manoeuvre, they mean these."""

GRADE, ICE = atan(0.12), 0.12
"""Slope of a hill in rad, friction coefficient of ice."""

EVERYDAY = (
    step("regen", "from driving to regenerative braking at 50 km/h", 50 * KMH, 60.0, -60.0),
    step("regenr", "from driving to regenerative braking at 50 km/h in 200 ms", 50 * KMH, 60.0, -60.0, 0.2),
    Manoeuvre(
        name="one_pedal_soft",
        description="brake by the motor alone from 20 km/h, gently to rest, then held by the brakes",
        duration=10.0,
        v_0=20 * KMH,
        T_driver=lines((6.5, -30.0), (8.3, 0.0)),
        T_brake=lines((8.0, 0.0), (9.0, 1500.0)),
        t_0=0.5,
    ),
    Manoeuvre(
        name="one_pedal_hard",
        description="brake by the motor alone from 30 km/h, hard until the car stands, then held by the brakes",
        duration=6.0,
        v_0=30 * KMH,
        T_driver=lines((3.6, -90.0), (4.4, 0.0)),
        T_brake=lines((4.2, 0.0), (4.4, 1500.0)),
        t_0=0.5,
    ),
    Manoeuvre(
        name="blending",
        description="brake by the motor from 25 km/h; the brakes take over before the car stands",
        duration=8.0,
        v_0=25 * KMH,
        T_driver=lines((4.0, -60.0), (4.3, 0.0)),
        T_brake=lines((4.0, 0.0), (4.3, 1200.0)),
        t_0=0.5,
    ),
    Manoeuvre(
        name="hill_start",
        description="let go of the brakes on a 12 % grade, pull away after a moment of rolling back, stop and hold",
        duration=9.0,
        v_0=0.0,
        T_driver=lines((2.3, 0.0), (2.6, 120.0), (4.5, 120.0), (4.8, 20.0), (6.5, 20.0), (6.8, 0.0)),
        T_brake=lines((2.0, 1500.0), (2.2, 0.0), (5.5, 0.0), (6.0, 2500.0)),
        slope=lines((0.2, 0.0), (0.7, GRADE)),
        t_0=2.0,
    ),
    parking("park_forward", "creep forwards and stop, twice", 1.0),
    parking("park_back", "creep backwards and stop, twice", -1.0),
    Manoeuvre(
        name="throttle",
        description="the foot swings at 2 Hz at 50 km/h, through the backlash",
        duration=6.0,
        v_0=50 * KMH,
        T_driver=FlatSine(mean=20.0, amplitude=100.0, frequency=2.0, steepness=1.5),
    ),
    Manoeuvre(
        name="abs",
        description="brake pulses at 5 Hz from 22 m/s, in which the wheels slip to half the speed of the car",
        duration=4.0,
        v_0=22.0,
        T_driver=lines((0.8, 12.0), (1.0, 0.0)),
        T_brake=lines(*(corner for k in range(10, 34, 2) for corner in brake_pulse(k / 10, (k + 1) / 10))),
        t_0=1.0,
    ),
    Manoeuvre(
        name="launch_ice",
        description="pull away on ice within 100 ms, and ease off as the wheels spin",
        duration=6.0,
        v_0=0.0,
        T_driver=lines((1.0, 0.0), (1.1, 120.0), (1.6, 120.0), (1.8, 15.0)),
        t_0=1.0,
        road={"mu": ICE},
    ),
    Manoeuvre(
        name="launch_split",
        description="pull away within 100 ms with the left wheel on ice, and ease off as it spins",
        duration=6.0,
        v_0=0.0,
        T_driver=lines((1.0, 0.0), (1.1, 120.0), (1.6, 120.0), (1.8, 15.0)),
        t_0=1.0,
        road={"g_muL": ICE},
    ),
    Manoeuvre(
        name="ice_hill",
        description="roll back on a 12 % grade of ice, push until the wheels spin, and ease off",
        duration=6.0,
        v_0=0.0,
        T_driver=lines((2.0, 0.0), (2.0, 120.0), (2.5, 120.0), (2.7, 15.0)),
        slope=lines((0.2, 0.0), (0.7, GRADE)),
        t_0=2.0,
        road={"mu": ICE},
    ),
)
"""The days of an electric car."""

MANOEUVRES: dict[str, Manoeuvre] = ByName((manoeuvre.name, manoeuvre) for manoeuvre in (*USUAL_MANOEUVRES, *EVERYDAY))
"""The manoeuvres of the project, by name."""

TOWN_DRIVE = Path(__file__).parent / "data" / "town_drive.csv"
"""A short drive in town of our own making, in the layout of a recording."""

COMPARED = tuple(m.name for m in USUAL_MANOEUVRES if m.name not in ("prbs15", "launch_brake", "hill_hold"))

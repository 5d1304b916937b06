"""The manoeuvres that the loop is driven through, by name."""

from dataclasses import replace

from .demand_shape import plateau_ends
from .manoeuvre import Manoeuvre
from .prbs import binary_torque
from .signals import FlatSine, lines

KMH = 1.0 / 3.6


def step(name: str, description: str, v_0: float, before: float, after: float, rise: float = 0.0) -> Manoeuvre:
    """The demand goes from one torque (N.m) to another at 1 s, in a jump or within `rise` seconds."""
    demand = lines((0.0, before), (1.0, before), (1.0 + rise, after))
    return Manoeuvre(name, description, 6.0, v_0, demand, t_0=1.0, dT=after - before)


DRIVE = lines(
    (0.0, 12.0), (0.5, 12.0), (0.7, 100.0), (2.0, 100.0), (2.2, 30.0), (3.2, 30.0), (3.3, 125.0),
    (4.5, 125.0), (4.6, -18.0), (5.6, -18.0), (5.8, 80.0), (7.0, 80.0), (7.1, 12.0), (8.0, 12.0),
    (8.2, 110.0), (9.4, 110.0), (9.5, -24.0), (10.6, -24.0), (10.7, 70.0), (12.0, 70.0), (12.2, 130.0),
    (13.2, 130.0), (13.3, -28.0), (14.5, -28.0), (14.8, 45.0), (16.0, 45.0), (16.3, -24.0), (20.0, -24.0),
)  # fmt: skip

_PRBS = binary_torque("prbs", mean=8.0, amplitude=15.0, clock=0.04, order=9, duration=10.0, v_0=15 * KMH)

MANOEUVRES: dict[str, Manoeuvre] = {
    manoeuvre.name: manoeuvre
    for manoeuvre in (
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
}
"""The manoeuvres of the project, by name."""

COMPARED = tuple(name for name in MANOEUVRES if name not in ("prbs15", "launch_brake", "hill_hold"))

"""A short drive in town of our own making, in the layout of a recording.

    python -m docs.studies.town_drive

writes it again to `harness/manoeuvres/data/town_drive.csv`: an uneven foot, passages of the torque through zero, a
stop at a light. The speed is that of a point mass, sampled and rounded as a recording would be.
"""

import math
from pathlib import Path

import numpy as np

from driveline.harness.manoeuvres.catalogue import TOWN_DRIVE
from driveline.harness.manoeuvres.road_load import ROTATING_MASS, RoadLoad
from driveline.harness.manoeuvres.signals import lines

CAR = RoadLoad(i=9.0, r=0.29, m=1450.0, g=9.81, c_rr=0.012, c_wa=0.42)
T_END, INTERVAL, STEP_SIZE = 62.0, 0.1, 0.01

TORQUE = lines(
    (0.0, 0.0), (2.0, 0.0), (2.3, 95.0), (4.8, 90.0), (5.0, 25.0), (6.4, 30.0), (6.6, 115.0), (8.6, 105.0),
    (8.8, -22.0), (10.2, -18.0), (10.4, 85.0), (11.8, 75.0), (12.0, 6.0), (12.8, 14.0), (13.4, -8.0),
    (14.2, 16.0), (14.8, -6.0), (15.6, 18.0), (16.2, -7.0), (17.0, 12.0), (17.2, 70.0), (18.6, 60.0),
    (18.8, -30.0), (23.8, -35.0), (25.0, 0.0), (33.0, 0.0), (33.2, 125.0), (36.4, 115.0), (36.6, 20.0),
    (37.6, 24.0), (37.8, 100.0), (39.4, 95.0), (39.6, -28.0), (41.0, -24.0), (41.2, 60.0), (43.0, 55.0),
    (43.5, 10.0), (44.3, -8.0), (45.1, 14.0), (45.9, -10.0), (46.5, 65.0), (48.0, 70.0), (48.2, -20.0),
    (49.4, -25.0), (49.6, 40.0), (51.0, 35.0), (51.2, -35.0), (58.0, -35.0), (59.0, 0.0), (T_END, 0.0),
)  # fmt: skip
"""Torque of the motor in N.m."""

BRAKE = lines(
    (19.5, 0.0), (20.5, 2600.0), (30.5, 2600.0), (31.0, 0.0), (52.5, 0.0), (53.5, 2600.0), (T_END, 2600.0)
)  # fmt: skip
"""Force of the friction brakes in N."""


def elevation(distance: float) -> float:
    """Height of the road in m: a gentle hill."""
    return 520.0 + 1.0 * (1.0 - math.cos(2.0 * math.pi * distance / 500.0))


def samples() -> np.ndarray:
    """Rows of time in s, speed in km/h, elevation in m and motor torque in N.m."""
    v = distance = 0.0
    rows = []
    per_sample = round(INTERVAL / STEP_SIZE)
    for k in range(round(T_END / STEP_SIZE) + 1):
        t = k * STEP_SIZE
        # no motor recuperates down to standstill
        demand = float(TORQUE(t))
        T_mot = demand if demand >= 0.0 else demand * min(1.0, v / 3.0) + 0.0
        if k % per_sample == 0:
            rows.append((round(t, 1), round(3.6 * v, 2), round(elevation(distance), 1), round(T_mot, 2)))
        slope = (elevation(distance + 0.5) - elevation(distance - 0.5)) / 1.0
        push = CAR.i * T_mot / CAR.r - CAR.m * CAR.g * slope - CAR.c_wa * v * v
        resistance = CAR.m * CAR.g * CAR.c_rr + float(BRAKE(t))
        standing = v == 0.0 and push <= resistance
        v = 0.0 if standing else max(0.0, v + STEP_SIZE * (push - resistance) / (ROTATING_MASS * CAR.m))
        distance += STEP_SIZE * v
    return np.array(rows)


def write(path: Path) -> None:
    """Writes the drive as a recording."""
    rows = [f"{t:.1f},{v:.2f},{height:.1f},{T:.2f}" for t, v, height, T in samples()]
    header = "Time [s],Velocity [km/h],Elevation [m],Motor Torque [Nm]"
    path.write_text("\n".join((header, *rows)) + "\n", encoding="utf-8")


if __name__ == "__main__":
    write(TOWN_DRIVE)

"""The picture of the loop: where its blocks stand, where their connectors are, and how the lines between them run.

As in docs/figures/loop.svg, with the source on the left; x to the right and y up, as the standard has it.
"""

from typing import NamedTuple

from .loop_with_source import SOURCE


class Box(NamedTuple):
    """A rectangle by its lower left and upper right corners."""

    x1: float
    y1: float
    x2: float
    y2: float


class Place(NamedTuple):
    """Of a connector on its box, from 0, 0 at the lower left to 1, 1 at the upper right."""

    x: float
    y: float


BOXES = {
    SOURCE: Box(20.0, 160.0, 170.0, 260.0),
    "controller": Box(270.0, 160.0, 440.0, 260.0),
    "motor": Box(540.0, 160.0, 690.0, 260.0),
    "plant": Box(790.0, 160.0, 980.0, 260.0),
    "can": Box(540.0, 20.0, 690.0, 90.0),
}

PLACES = {
    f"{SOURCE}.T_driver": Place(1.0, 0.7),
    f"{SOURCE}.enable": Place(1.0, 0.3),
    f"{SOURCE}.T_brake": Place(0.4, 1.0),
    f"{SOURCE}.slope": Place(0.7, 1.0),
    "controller.T_driver": Place(0.0, 0.7),
    "controller.enable": Place(0.0, 0.3),
    "controller.T_ref": Place(1.0, 0.7),
    "controller.T_mot_est": Place(1.0, 0.4),
    "controller.omega_1_meas": Place(1.0, 0.2),
    "controller.omega_2_can": Place(0.75, 0.0),
    "controller.valid": Place(0.5, 0.0),
    "controller.counter": Place(0.25, 0.0),
    "motor.T_ref": Place(0.0, 0.7),
    "motor.T_mot_est": Place(0.0, 0.4),
    "motor.omega_1_meas": Place(0.0, 0.2),
    "motor.T_mot": Place(1.0, 0.7),
    "motor.omega_1": Place(1.0, 0.3),
    "plant.T_mot": Place(0.0, 0.7),
    "plant.omega_1": Place(0.0, 0.3),
    "plant.T_brake": Place(0.65, 1.0),
    "plant.slope": Place(0.35, 1.0),
    "plant.omega_wheel_L": Place(0.35, 0.0),
    "plant.omega_wheel_R": Place(0.65, 0.0),
    "can.omega_wheel_L": Place(1.0, 0.7),
    "can.omega_wheel_R": Place(1.0, 0.3),
    "can.omega_2_can": Place(0.0, 0.75),
    "can.valid": Place(0.0, 0.5),
    "can.counter": Place(0.0, 0.25),
}

ABOVE = {"plant.T_brake": 295.0, "plant.slope": 277.0}
"""Height at which lines run that come from the top of a box and go to the top of another."""


def corners(source: str, target: str) -> tuple[tuple[float, float], ...]:
    """Of the line between two connectors `instance.variable`; none if it is straight or they have no place."""
    if not (source in PLACES and target in PLACES):
        return ()
    begin, end = _point(source), _point(target)
    if target in ABOVE:
        return (begin[0], ABOVE[target]), (end[0], ABOVE[target])
    if PLACES[source].y in (0.0, 1.0):
        return ((begin[0], end[1]),)
    if PLACES[target].y in (0.0, 1.0):
        return ((end[0], begin[1]),)
    return ()


def _point(name: str) -> tuple[float, float]:
    box, place = BOXES[name.partition(".")[0]], PLACES[name]
    return box.x1 + place.x * (box.x2 - box.x1), box.y1 + place.y * (box.y2 - box.y1)

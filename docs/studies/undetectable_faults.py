"""Undetectable faults of the motor speed: how much does the gear swing with them, over that without control?

Each is there from the first sample to the last of a manoeuvre of 6 s. The table has the gear torque (rms of 5 to
50 Hz) with the fault over that without control, and the share of the samples in fallback.
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from driveline.harness.manoeuvres.catalogue import MANOEUVRES, step
from driveline.harness.metrics.spectrum import band_rms
from driveline.models.controller.supervision import FALLBACK
from fmuloop.many_runs import run_many

from . import monolithic
from .study import Cell, Column, Measured, Study, Table

LATE = 0.062
"""Delay in s: half a period of the swing."""

ROUNDING = 1e-9
"""Of times, in s."""

FAULTS: dict[str, Callable[[float], float]] = {
    "200 rad/s too much": lambda omega_1: omega_1 + 200.0,
    "half of it": lambda omega_1: 0.5 * omega_1,
    "exactly 0": lambda omega_1: 0.0,
    "wrong sign": lambda omega_1: -omega_1,
}
"""What is received of the motor speed, beside a late one."""

SLOW = {
    f"launch in {rise} s": step(f"launch in {rise} s", f"pull away within {rise} s", 0.0, 0.0, 120.0, rise)
    for rise in (0.5, 1.0, 2.0, 4.0)
}
"""Launches that give the wrong sign more time before the motor turns against a demand."""

BRIEF = {"tipin15, 2 s of it": replace(MANOEUVRES["tipin15"], duration=2.0)}
"""For the sentinel."""

CASES = (
    *(("launch", fault) for fault in FAULTS),
    *((slow, "wrong sign") for slow in SLOW),
    ("launch", "late"),
    ("tipin15", "late"),
    ("prbs", "late"),
    ("throttle", "late"),
    *((brief, "late") for brief in BRIEF),
)


def received(fault: str) -> Callable[[float, Any], Any]:
    """What reaches the controller of what was sent."""
    sent_before: list[tuple[float, float]] = []

    def late(t: float, sent: Any) -> Any:
        sent_before.append((t, sent.omega_1_meas))
        while len(sent_before) > 1 and sent_before[1][0] <= t - LATE + ROUNDING:
            del sent_before[0]
        return sent._replace(omega_1_meas=sent_before[0][1])

    if fault == "late":
        return late
    return lambda _t, sent: sent._replace(omega_1_meas=FAULTS[fault](sent.omega_1_meas))


def swing(plant: str, manoeuvre: str, fault: str | None) -> tuple[float, float]:
    """Rms of the gear torque in N.m, and the share in fallback; without control if there is no fault."""
    course = (MANOEUVRES | SLOW | BRIEF)[manoeuvre]

    def signals(k: int) -> tuple[float, float, float]:
        t = k * monolithic.INTERVAL
        return float(course.T_driver(t)), float(course.T_brake(t)), float(course.slope(t))

    start = {"plant": {"v_0": course.v_0, "T_0": course.T_0}}
    arguments = (received(fault),) if fault else ()
    y = monolithic.run(monolithic.PLANTS[plant], signals, course.duration, start, fault is not None, *arguments)
    rms = band_rms(y["plant.T_gear"], monolithic.INTERVAL)
    return rms, float(np.mean(y["controller.status"] == FALLBACK))


def faults_table(cases: Sequence[tuple[str, str]], plants: Collection[str] = tuple(monolithic.PLANTS)) -> Table:
    """A row for each manoeuvre with a fault on a plant."""
    alone = dict.fromkeys((plant, manoeuvre, None) for plant in plants for manoeuvre, _ in cases)
    todo = [*alone, *((plant, *case) for plant in plants for case in cases)]
    answers = dict(zip(todo, run_many(lambda case: swing(*case), todo, label="faults"), strict=True))
    rows: dict[str, tuple[Cell, ...]] = {}
    for plant, manoeuvre, fault in todo[len(alone) :]:
        rms, share = answers[plant, manoeuvre, fault]
        rows[f"{manoeuvre}, {fault}, {plant}"] = (rms / answers[plant, manoeuvre, None][0], 100.0 * share)
    columns = (Column("over without control"), Column("in fallback", "%", 0))
    return Table("manoeuvre, motor speed, plant", columns, rows)


SENTINEL = ("tipin15, 2 s of it", "late")
PLANT = next(iter(monolithic.PLANTS))

STUDY = Study(
    "faults of the motor speed that no other signal contradicts",
    lambda: Measured({"faults": faults_table(CASES)}),
    lambda: {"faults": faults_table([SENTINEL], [PLANT])},
    {"faults": [f"{', '.join(SENTINEL)}, {PLANT}"]},
    seconds=60,
)

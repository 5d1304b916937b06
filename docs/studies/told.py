"""What is gained by what only the car can tell: frames that are counted, and ABS that says that it is active.

The runs of `roads` with ours: gear torque over that without control, with and without being told.
"""

from collections.abc import Iterator
from itertools import islice, product

import numpy as np

from driveline.harness.loop.places import T_S
from driveline.harness.studies.faults.fault_injection import COUNTED
from driveline.models.signal_faults import FRAME

from .roads import NOTHING_TOLD, OURS, Run, frames_table, groups_table, measured, pulses, runs_table, with_late_signals
from .study import Measured, Study, Table


def active(t: np.ndarray) -> np.ndarray:
    """Whether ABS is, as it tells: from the second period of 50 Hz on in which the brakes are pulsed."""
    return (t >= 1.02) & (t < 4.2)


def with_abs_and_regeneration() -> Iterator[Run]:
    for name, told in (("", NOTHING_TOLD), (", told", {"controller.slip_control": active})):
        for mu, frequency, T_brake, T_driver in product(
            (0.2, 0.5, 1.0), (4.0, 5.0, 8.0, 12.0), (500.0, 1900.0, 4000.0), (-20.0, -50.0, -80.0)
        ):
            course = pulses(frequency, T_brake, T_driver=T_driver)
            yield Run(f"ABS with regeneration{name}, mu {mu:g}", course, 1.0, {"mu": mu}, told=told)


def count(t: np.ndarray) -> np.ndarray:
    """Of the frames that motor control has sent, one in each sample of the controller."""
    return 1.0 + np.floor(t / T_S + 0.5)


def with_counted_frames() -> Iterator[Run]:
    """A frame is late whether it is counted or not."""
    for what, told in (("frame", NOTHING_TOLD), ("counted frame", {COUNTED: count})):
        for late in (0.01, 0.02, 0.022, 0.03, 0.04, 0.052, 0.07, 0.1):
            yield from with_late_signals(what, FRAME, late, told)


SENTINELS = {
    "counted": list(islice(with_counted_frames(), 80, 81)),
    "regeneration": list(islice(with_abs_and_regeneration(), 1)),
}


def measure() -> Measured:
    counted, braked = list(with_counted_frames()), list(with_abs_and_regeneration())
    return Measured(
        {
            "counted": frames_table(counted, {OURS: measured(counted, OURS, "counted frames")}),
            "regeneration": groups_table(braked, measured(braked, OURS, "regeneration")),
            "runs": again()["runs"],
        }
    )


def again() -> dict[str, Table]:
    runs = [run for of in SENTINELS.values() for run in of]
    return {"runs": runs_table(runs, measured(runs, OURS, "told"))}


STUDY = Study(
    "what is gained by what only the car can tell",
    measure,
    again,
    {"runs": [f"{run.group}: {run}" for of in SENTINELS.values() for run in of]},
    seconds=20,
)

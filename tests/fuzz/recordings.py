"""Recorded drives."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random

import numpy as np

from harness.errors import DrivelineError
from harness.manoeuvres.follower import drive, needed_force
from harness.manoeuvres.road import RoadLoad, Track
from harness.recordings.drive import read_drive

from .damage import ODD, spoiled_bytes, spoiled_text
from .target import Attempt, Target, Unclean

SOUND = "Time [s],Velocity [km/h],Elevation [m],Motor Torque [Nm]\n" + "".join(
    f"{0.1 * k:.1f},{20.0 + 0.1 * k:.2f},{500.0 + 0.01 * k:.2f},{k % 7 * 5.0:.2f}\n" for k in range(30)
)
CAR = RoadLoad(i=9.0, r=0.29, m=1450.0, g=9.81, c_rr=0.012, c_wa=0.42)


def other_cells(text: str, random: Random) -> str:
    lines = [line.split(",") for line in text.splitlines()]
    for _ in range(random.randint(1, 4)):
        line = random.choice(lines)
        line[random.randrange(len(line))] = random.choice((*ODD, "1e12", "1e9", "-40", "5"))
    return "\n".join(",".join(line) for line in lines)


def damaged(random: Random) -> bytes:
    content = random.choice((other_cells, spoiled_text))(SOUND, random).encode("utf-8", "surrogatepass")
    return spoiled_bytes(content, random) if random.random() < 0.2 else content


@contextmanager
def attempts(folder: Path) -> Iterator[Attempt]:
    def attempt(random: Random) -> str:
        path = folder / "drive.csv"
        path.write_bytes(damaged(random))
        try:
            track = Track.of(read_drive(path))
            manoeuvre = drive(track, CAR, needed_force(track, CAR), held=random.choice((None, 0.5)))
        except DrivelineError as refusal:
            if "\n" in str(refusal):
                raise Unclean(f"{path.read_bytes()!r}: {refusal}") from refusal
            return "refused in one line"
        t = np.linspace(0.0, manoeuvre.duration, 50)
        for signal in (manoeuvre.T_driver, manoeuvre.T_brake, manoeuvre.slope):
            if not np.isfinite(signal(t)).all():
                raise Unclean(f"{path.read_bytes()!r}: a signal that is not finite")
        return "driven"

    yield attempt


TARGET = Target(
    "damaged recordings of drives",
    "a drive with finite signals, or one line that refuses it",
    attempts,
    short=300,
    long=100_000,
)

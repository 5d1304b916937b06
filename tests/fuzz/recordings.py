"""Recordings: drives to replay and drives to identify from, in every format."""

import logging
from collections.abc import Callable, Iterator
from multiprocessing import get_context
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

from driveline.harness.manoeuvres.road_load import RoadLoad, Track
from driveline.harness.manoeuvres.speed_following import drive, needed_force
from driverecords.bounded_reading import outcome
from driverecords.drive import read_drive
from driverecords.format_detection import is_text
from driverecords.measurement import read_measurement
from driverecords.source import RecordingError
from packages.driverecords.tests.car import RADIUS, RATIO
from packages.driverecords.tests.car import drive as excited
from packages.driverecords.tests.variants import TEXTS, recording, write_arrow, write_mdf
from tests.fuzz.damage import ODD, spoiled_bytes, spoiled_text
from tests.fuzz.target import Attempt, Unclean, target
from toolground.errors import UserError
from toolground.file_limits import PATIENCE

SOUND = "Time [s],Velocity [km/h],Elevation [m],Motor Torque [Nm]\n" + "".join(
    f"{0.1 * k:.1f},{20.0 + 0.1 * k:.2f},{500.0 + 0.01 * k:.2f},{k % 7 * 5.0:.2f}\n" for k in range(30)
)
CAR = RoadLoad(i=RATIO, r=RADIUS, m=1450.0, g=9.81, c_rr=0.012, c_wa=0.42)


def other_cells(text: str, random: Random) -> str:
    lines = [line.split(",") for line in text.splitlines()]
    for _ in range(random.randint(1, 4)):
        line = random.choice(lines)
        line[random.randrange(len(line))] = random.choice((*ODD, "1e12", "1e9", "-40", "5"))
    return "\n".join(",".join(line) for line in lines)


def damaged_text(random: Random) -> bytes:
    content = random.choice((other_cells, spoiled_text))(SOUND, random).encode("utf-8", "surrogatepass")
    return spoiled_bytes(content, random) if random.random() < 0.2 else content


def measured() -> str:
    """A drive to identify from, as text."""
    one = excited(2.5)
    rows = np.column_stack([one["time"], one["omega_1"], one["T_mot"], one["omega_2"] / RATIO, -RATIO * one["T_load"]])
    lines = (",".join(f"{value:.6g}" for value in row) for row in rows.tolist())
    heading = "Time [s],Motor Speed [rad/s],Motor Torque [N.m],Wheel Speed [rad/s],Wheel Torque [N.m]"
    return "\n".join((heading, *lines))


def sound_files(folder: Path) -> list[bytes]:
    """One drive in every text dialect and in every binary format."""
    one = recording(30)
    files = [text(one) for text in TEXTS.values()]
    for name, write in (("a.mf4", write_mdf), ("a.parquet", write_arrow), ("a.feather", write_arrow)):
        write(one, folder / name)
        files.append((folder / name).read_bytes())
        (folder / name).unlink()
    return files


FORK = get_context("fork")


def apart(read: Any) -> Any:
    """The reader, without limits, of a file that is no text in a copy of this process: packages crash over some. A
    process that begins anew, as for users, takes most of a second."""

    def answered(path: Path, *others: float) -> Any:
        if is_text(path):
            return read.__wrapped__(path, *others)
        receiver, sender = FORK.Pipe(duplex=False)
        child = FORK.Process(target=lambda: sender.send(outcome(read.__module__, read.__name__, (path, *others), {})))
        child.start()
        sender.close()
        try:
            answer = receiver.recv() if receiver.poll(PATIENCE) else TimeoutError(f"no answer in {PATIENCE} s")
        except EOFError:
            answer = RecordingError(f"{path} ended the process that read it")
        child.kill()
        child.join()
        if isinstance(answer, Exception):
            raise answer
        return answer

    return answered


def driven(path: Path, random: Random) -> list[np.ndarray]:
    """The signals of a drive."""
    track = Track.of(apart(read_drive)(path))
    manoeuvre = drive(track, CAR, needed_force(track, CAR), held=random.choice((None, 0.5)))
    t = np.linspace(0.0, manoeuvre.duration, 50)
    return [signal(t) for signal in (manoeuvre.T_driver, manoeuvre.T_brake, manoeuvre.slope)]


def identified(path: Path, random: Random) -> list[np.ndarray]:
    """The signals of a drive to identify from."""
    found = apart(read_measurement)(path, RATIO, RADIUS)
    return [x for x in (found.time, found.T_mot, found.omega_1, found.omega_2, found.T_load) if x is not None]


@target(
    "damaged recordings, as text of every dialect, MDF, Parquet and Feather",
    "a drive with finite signals, or one line that refuses it",
    short=40,
    long=100_000,
)
def attempts(folder: Path) -> Iterator[Attempt]:
    logging.getLogger("asammdf").setLevel(logging.CRITICAL)
    files, other = sound_files(folder), measured()

    def drawn(random: Random) -> tuple[bytes, Callable[[Path, Random], list[np.ndarray]]]:
        kind = random.random()
        if kind < 0.5:
            return damaged_text(random), driven
        if kind < 0.9:
            return spoiled_bytes(random.choice(files), random), driven
        return random.choice((other_cells, spoiled_text))(other, random).encode("utf-8", "surrogatepass"), identified

    def attempt(random: Random) -> str:
        path = folder / "drive.csv"
        content, use = drawn(random)
        path.write_bytes(content)
        try:
            signals = use(path, random)
        except UserError as refusal:
            if "\n" in str(refusal) or not str(refusal).isprintable():
                raise Unclean(f"{content[:3000]!r}: {refusal}") from refusal
            return "refused in one line"
        except Exception as fault:
            raise Unclean(f"{content[:3000]!r}: {type(fault).__name__}: {fault}") from fault
        if not all(np.isfinite(signal).all() for signal in signals):
            raise Unclean(f"{content[:3000]!r}: a signal that is not finite")
        return "driven"

    yield attempt

"""Time and memory in which large recordings are read, in every kind of file: an hour at 1 kHz with the channels of a
replay, and a million rows with 20 columns. The seconds are those of computing, of all processes.

    python -m benchmarks.recordings
"""

import resource
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import asammdf
import can
import numpy as np
import pandas as pd

from driveline.harness.base.interruption import script

DBC = """VERSION ""
BU_: ECU
BO_ 256 Motor: 8 ECU
 SG_ Motor_Torque : 0|16@1- (0.1,0) [0|0] "Nm" ECU
 SG_ Vehicle_Speed : 16|16@1+ (0.01,0) [0|0] "km/h" ECU
 SG_ Elevation : 32|16@1+ (0.5,-1000) [0|0] "m" ECU
"""

READ = """
import sys
from pathlib import Path
from driveline.harness.recordings.drive import read_drive
path = Path(sys.argv[1])
databases = [path.with_suffix(".dbc")] if path.suffix == ".blf" else []
assert len(read_drive(path, databases=databases).time) == int(sys.argv[2])
"""


def drive(rows: int, others: int) -> pd.DataFrame:
    t, random = 0.001 * np.arange(rows), np.random.default_rng(1)
    signals = {
        "Time [s]": t,
        "Motor Torque [Nm]": 20.0 + 5.0 * np.sin(t),
        "Velocity [km/h]": 50.0 + 10.0 * np.sin(t / 30.0),
        "Elevation [m]": 500.0 + 5.0 * np.sin(t / 60.0),
    }
    return pd.DataFrame(signals | {f"x{k}": random.normal(size=rows) for k in range(others)})


def write_mdf(table: pd.DataFrame, path: Path) -> None:
    with asammdf.MDF() as file:
        time = table.iloc[:, 0].to_numpy()
        parts = [(heading, *heading.rstrip("]").partition(" [")[::2]) for heading in table.columns[1:]]
        file.append([asammdf.Signal(table[key].to_numpy(), time, name=name, unit=unit) for key, name, unit in parts])
        file.save(path, compression=2)


def write_log(table: pd.DataFrame, path: Path) -> None:
    """The first signals, a frame a row."""
    path.with_suffix(".dbc").write_text(DBC, encoding="ascii")
    signals = np.round(table.to_numpy()[:, 1:4] * [10.0, 100.0, 2.0] + [0.0, 0.0, 2000.0]).astype("<i2")
    with can.Logger(path) as log:
        for k, row in enumerate(signals):
            data = row.tobytes() + bytes(2)
            log.on_message_received(
                can.Message(timestamp=0.001 * k, arbitration_id=256, is_extended_id=False, data=data)
            )


KINDS: Mapping[str, Callable[[pd.DataFrame, Path], object]] = {
    "csv": lambda table, path: table.to_csv(path, index=False, float_format="%.7g"),
    "parquet": lambda table, path: table.to_parquet(path, index=False),
    "mf4": write_mdf,
    "blf": write_log,
}


def read(path: Path, rows: int) -> str:
    """What reading takes, in words."""
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), perf_counter()
    subprocess.run([sys.executable, "-c", READ, str(path), str(rows)], check=True)
    lasted, after = perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    computed = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return f"{computed:.1f} s of computing, {lasted:.1f} s in all, at most {after.ru_maxrss * 1024 / 1e6:.0f} MB"


def one(kind: str, rows: int, others: int) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"drive.{kind}"
        KINDS[kind](drive(rows, others), path)
        size = path.stat().st_size / 1e6
        print(f"{rows} rows, {others + 4} columns, {kind}, {size:.0f} MB: {read(path, rows)}", flush=True)


def main() -> None:
    if sys.argv[1:]:
        one(sys.argv[1], *map(int, sys.argv[2:]))
        return
    for rows, others in ((3_600_000, 0), (1_000_000, 16)):
        for kind in KINDS:
            if others == 0 or kind != "blf":
                arguments = [kind, str(rows), str(others)]  # a process each, whose children tell their own memory
                subprocess.run([sys.executable, "-m", __spec__.name, *arguments], check=True)


if __name__ == "__main__":
    script(main)

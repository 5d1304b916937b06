"""Recordings of drives by any logger as checked signals in SI: CSV in every dialect, MDF, Parquet, logs of the CAN bus.

    from pathlib import Path
    from driverecords import of_drive, read_drive

    drive = read_drive(Path("my_trip.csv"))  # columns are found by name and unit
    print(drive.v.max(), "m/s")
    for finding in of_drive(drive):
        print(finding)  # what cannot be true, with column and time

What cannot be read is a `RecordingError`, which names file, column and line. What stands in `__init__.pyi` is public.
"""

from toolground.public_names import public_names

__getattr__, __dir__ = public_names(__name__, __file__)

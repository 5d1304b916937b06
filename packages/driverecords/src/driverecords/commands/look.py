"""Says what was found in a recorded drive: which column is which quantity, in which unit, how it was sampled, and what
makes it implausible (signs, units, rates, codes for missing values, spikes, jumps), with column and time.

The recording is a file of a logger (CSV, MDF, Parquet, BLF, ASC and others) with the columns

  {columns}

under any name that is usual (`--aliases` adds names, `--column` says what a column holds).

examples:
  driverecords look my_trip.csv
  driverecords look my_trip.blf --dbc drive_train.dbc --json
  driverecords look bench.csv --column v='n_roller [km/h]' --column T_mot='-M_em [Nm]'
  driverecords look my_trip.mf4 --from 12.5 --to 60
"""

from pathlib import Path

from toolground.arguments import positional, record
from toolground.printing import JsonPrinting

from ..arguments import Headings, examples

IN_HELP = {"columns": ", ".join(examples("time", "v", "elevation", "T_mot"))}


@record
class Arguments(Headings, JsonPrinting):
    recordings: tuple[Path, ...] = positional("the recorded drives", Path, "RECORDING", "+")


def run(args: Arguments) -> int:
    # here and not above: mistakes and help are answered without them
    from ..column_table import document, show
    from ..drive import read_drive
    from ..plausibility import of_drive

    drives = {path: read_drive(path, **args.as_read) for path in args.recordings}
    odd = {path: of_drive(drive) for path, drive in drives.items()}
    for path, drive in drives.items():
        show(args, path, drive, odd[path])
    documents = ({"recording": path, **document(drive, odd[path])} for path, drive in drives.items())
    args.document({"recordings": list(documents)})
    return 0

"""The recording that a command reads: the file, and what its columns are called."""

import argparse
from pathlib import Path
from typing import Any

from ..base.known_names import nearest
from ..base.plain_text import quoted
from ..recordings.quantities import QUANTITIES


def add_recording(parser: argparse.ArgumentParser, what: str, **how: Any) -> None:
    """RECORDING, --dbc, --column and --aliases.

    Args:
        what: is recorded, for help.
        how: further arguments of `add_argument` for RECORDING.
    """
    parser.add_argument("recording", type=Path, metavar="RECORDING", help=f"{what} (docs/recordings.md)", **how)
    parser.add_argument(
        "--dbc",
        action="append",
        default=[],
        type=Path,
        dest="databases",
        metavar="FILE.dbc",
        help="of a log of a bus (BLF, ASC): what its frames mean (repeatable)",
    )
    parser.add_argument(
        "--column",
        action="append",
        default=[],
        type=column,
        dest="columns",
        metavar="QUANTITY=HEADING",
        help="the column of a quantity, where its name does not tell, as in v='Speed 2 [km/h]'; with a minus before "
        f"the heading its sign is turned; quantities: {', '.join(QUANTITIES)} (repeatable)",
    )
    parser.add_argument(
        "--aliases",
        action="append",
        default=[],
        type=Path,
        metavar="FILE.toml",
        help="more names of quantities, as in omega_1 = ['n_EM1'] (repeatable)",
    )


def files_of(args: argparse.Namespace) -> list[Path]:
    """What is read: recording, databases of the bus, names."""
    return [args.recording, *args.databases, *args.aliases]


def of_recording(args: argparse.Namespace) -> dict[str, Any]:
    """What distinguishes a run by these files, which have been read, and by what the columns are said to be."""
    from ..simulation.provenance import digest

    given = {"databases": args.databases, "aliases": args.aliases}
    others = {name: [digest(path) for path in paths] for name, paths in given.items() if paths}
    return {"recording": digest(args.recording), "columns": dict(args.columns), **others}


def column(text: str) -> tuple[str, str]:
    """Quantity and heading of `quantity=heading`."""
    quantity, equals, heading = (part.strip() for part in text.partition("="))
    if not (quantity and equals and heading):
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not of the form v='Speed 2 [km/h]'")
    if quantity not in QUANTITIES:
        raise argparse.ArgumentTypeError(f"{quoted(quantity)} is no quantity; {nearest(quantity, QUANTITIES)}")
    return quantity, heading

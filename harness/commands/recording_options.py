"""The recording that a command reads: the file, and what its columns are called."""

import argparse
from pathlib import Path

from ..names import nearest
from ..plain import quoted
from ..recordings.quantities import QUANTITIES


def add_recording(parser: argparse.ArgumentParser, what: str) -> None:
    """RECORDING, --column and --aliases; `what` says what is recorded."""
    file = parser.add_argument("recording", type=Path, metavar="RECORDING", help=f"{what} (docs/recordings.md)")
    file.complete = "file"  # type: ignore[attr-defined]
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
    action = parser.add_argument(
        "--aliases",
        action="append",
        default=[],
        type=Path,
        metavar="FILE.toml",
        help="more names of quantities, as in omega_1 = ['n_EM1'] (repeatable)",
    )
    action.complete = "file"  # type: ignore[attr-defined]


def column(text: str) -> tuple[str, str]:
    """Quantity and heading of `quantity=heading`."""
    quantity, equals, heading = (part.strip() for part in text.partition("="))
    if not (quantity and equals and heading):
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not of the form v='Speed 2 [km/h]'")
    if quantity not in QUANTITIES:
        raise argparse.ArgumentTypeError(f"{quoted(quantity)} is no quantity; {nearest(quantity, QUANTITIES)}")
    return quantity, heading

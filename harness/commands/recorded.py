"""The recording that a command reads: the file, and what its columns are called."""

from argparse import ArgumentTypeError
from pathlib import Path
from typing import Any

from ..base.known_names import nearest
from ..base.plain_text import quoted
from ..recordings.quantities import QUANTITIES, aliases, example
from .arguments import option, positional
from .options import record

NAMES = aliases()


def examples(*quantities: str) -> list[str]:
    """Headings of quantities, for help."""
    return [example(quantity, NAMES) for quantity in quantities]


def column(text: str) -> tuple[str, str]:
    """Quantity and heading of `quantity=heading`."""
    quantity, equals, heading = (part.strip() for part in text.partition("="))
    if not (quantity and equals and heading):
        raise ArgumentTypeError(f"{quoted(text)} is not of the form v='Speed 2 [km/h]'")
    if quantity not in QUANTITIES:
        raise ArgumentTypeError(f"{quoted(quantity)} is no quantity; {nearest(quantity, QUANTITIES)}")
    return quantity, heading


def recording(what: str, nargs: str | None = None) -> Any:
    """RECORDING, of what is recorded."""
    return positional(f"{what} (docs/recordings.md)", Path, "RECORDING", nargs)


@record
class Headings:
    """What the columns of a recording are called."""

    dbc: tuple[Path, ...] = option(
        (), "of a log of a bus (BLF, ASC): what its frames mean (repeatable)", Path, metavar="FILE.dbc"
    )
    column: tuple[tuple[str, str], ...] = option(
        (), "as v='Speed 2 [km/h]', or T_mot=-Torque to turn a sign (repeatable)", column, metavar="QUANTITY=HEADING"
    )
    aliases: tuple[Path, ...] = option(
        (), "more names of quantities, as in omega_1 = ['n_EM1'] (repeatable)", Path, metavar="FILE.toml"
    )


@record
class Recorded(Headings):
    """Of a command that reads a recording."""

    recording: Path = recording("the recording")

    @property
    def read(self) -> list[Path]:
        """The files that are read: recording, databases of the bus, names."""
        return [self.recording, *self.dbc, *self.aliases]

    @property
    def distinguishing(self) -> dict[str, Any]:
        """What distinguishes a run by these files, which have been read, and by what the columns are said to be."""
        from ..base.digest import digest

        given = {"databases": self.dbc, "aliases": self.aliases}
        others = {name: [digest(path) for path in paths] for name, paths in given.items() if paths}
        return {"recording": digest(self.recording), "columns": dict(self.column), **others}

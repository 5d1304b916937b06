"""--manoeuvre: one of the catalogue by its name, or a file of the user's own."""

import argparse
from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.errors import DrivelineError
from ..base.known_names import nearest
from ..base.plain_text import plain
from ..manoeuvres.catalogue import MANOEUVRES
from ..manoeuvres.manoeuvre import Manoeuvre
from .options import names_or_files

if TYPE_CHECKING:
    from ..cosimulation.wiring import Fit

OWN = """\
a manoeuvre of your own: a TOML file with steps, ramps, pulses, sines, ... of demand, brake and slope, or a
table of them over time (docs/manoeuvres.md)"""


def add_manoeuvre(parser: argparse.ArgumentParser, what: str, **how: Any) -> None:
    """
    Args:
        what: is chosen, for help.
        how: further arguments of `add_argument`.
    """
    action = parser.add_argument("--manoeuvre", type=name_or_file, metavar="NAME|FILE", help=what, **how)
    action.complete = names_or_files(tuple(MANOEUVRES), ("toml", "csv"), "manoeuvre")  # type: ignore[attr-defined]


def name_or_file(text: str) -> str:
    """A name of the catalogue, or what has an ending and so is a file."""
    if text not in MANOEUVRES and not Path(text).suffix:
        shown = plain(text, 60) or "an empty name"
        raise argparse.ArgumentTypeError(
            f"{shown} is unknown; {nearest(text, MANOEUVRES)} (or give a .toml or .csv file)"
        )
    return text


def chosen(texts: Sequence[str]) -> dict[str, Manoeuvre]:
    """The manoeuvres by their names, in that order, each once.

    Raises:
        DrivelineError: a file is refused; two have the same name.
    """
    from ..manoeuvres.manoeuvre_file import read_manoeuvre

    found: dict[str, Manoeuvre] = {}
    for text in dict.fromkeys(texts):
        manoeuvre = MANOEUVRES[text] if text in MANOEUVRES else read_manoeuvre(Path(text))
        if found.setdefault(manoeuvre.name, manoeuvre) is not manoeuvre:
            raise DrivelineError(f"two manoeuvres are called {manoeuvre.name}; rename the file of one")
    return found


def files(texts: Sequence[str]) -> dict[str, Path]:
    """Of those that are files, by their names."""
    return {Path(text).stem: Path(text) for text in texts if text not in MANOEUVRES}


def digests(texts: Sequence[str]) -> dict[str, Any]:
    """What distinguishes a run by the files of its manoeuvres; nothing if there are none."""
    found = {name: sha256(path.read_bytes()).hexdigest() for name, path in files(texts).items()}
    return {"manoeuvre_files": found} if found else {}


def require_files_drivable(
    texts: Sequence[str], manoeuvres: Mapping[str, Manoeuvre], fitted: "Fit", parameters: Mapping[str, float]
) -> None:
    """Refuses those of files that a loop cannot be driven through, see `harness.manoeuvres.drivable`."""
    from ..manoeuvres.drivable import require_drivable

    for name, path in files(texts).items():
        require_drivable(manoeuvres[name], fitted, parameters, str(path))

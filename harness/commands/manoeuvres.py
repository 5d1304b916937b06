"""--manoeuvre: one of the catalogue by its name, or a file of the user's own."""

import argparse
import json
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..base.errors import DrivelineError
from ..base.known_names import nearest
from ..base.plain_text import plain
from ..loop.places import PLANTS
from ..loop.settings import Settings
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
    parser.add_argument("--list", action="store_true", help="print the manoeuvres and exit")
    action.complete = names_or_files(tuple(MANOEUVRES), ("toml", "csv"), "manoeuvre")  # type: ignore[attr-defined]


def print_manoeuvres(as_json: bool) -> None:
    """Prints the manoeuvres of the catalogue, a line each or as one document for tools."""
    if as_json:
        rows = [{"name": m.name, "description": m.description, "duration": m.duration} for m in MANOEUVRES.values()]
        print(json.dumps({"manoeuvres": rows}, indent=2))
        return
    width = max(map(len, MANOEUVRES))
    for each in MANOEUVRES.values():
        road = f"; for a plant with {', '.join(each.road)}: {PLANTS[1]}" if each.road else ""
        print(f"{each.name:{width}}  {each.description} ({each.duration:g} s{road})")


def name_or_file(text: str) -> str:
    """A name of the catalogue, or what has an ending and so is a file."""
    if text not in MANOEUVRES and not Path(text).suffix:
        shown = plain(text, 60) or "an empty name"
        raise argparse.ArgumentTypeError(
            f"{shown} is unknown; {nearest(text, MANOEUVRES)} (or give a .toml or .csv file)"
        )
    return text


class Chosen(NamedTuple):
    """What --manoeuvre says, once or several times.

    Attributes:
        manoeuvres: by their names, in the order in which they were given, each once.
        files: of those that are files.
    """

    manoeuvres: Mapping[str, Manoeuvre]
    files: Mapping[str, Path]

    @property
    def digests(self) -> dict[str, Any]:
        """What distinguishes a run by the files of its manoeuvres; nothing if there are none."""
        found = {name: sha256(path.read_bytes()).hexdigest() for name, path in self.files.items()}
        return {"manoeuvre_files": found} if found else {}

    def require_drivable(self, fits: "Mapping[str, Fit]", given: Mapping[str, Settings]) -> None:
        """Refuses those that the loops of the plants, by their names, cannot be driven through, see
        `harness.manoeuvres.drivable`; only those of files are not known to be within all bounds."""
        from ..manoeuvres.drivable import require_drivable, require_road

        for plant, fitted in fits.items():
            for manoeuvre in self.manoeuvres.values():
                require_road(manoeuvre, fitted)
            for name, path in self.files.items():
                require_drivable(self.manoeuvres[name], fitted, given[plant].parameters, str(path))


def chosen(texts: Iterable[str]) -> Chosen:
    """
    Args:
        texts: names of the catalogue and files.

    Raises:
        DrivelineError: a file is refused; two manoeuvres have the same name.
    """
    from ..manoeuvres.manoeuvre_file import read_manoeuvre

    found: dict[str, Manoeuvre] = {}
    for text in dict.fromkeys(texts):
        manoeuvre = MANOEUVRES[text] if text in MANOEUVRES else read_manoeuvre(Path(text))
        if found.setdefault(manoeuvre.name, manoeuvre) is not manoeuvre:
            raise DrivelineError(f"two manoeuvres are called {manoeuvre.name}; rename the file of one")
    return Chosen(found, {Path(text).stem: Path(text) for text in texts if text not in MANOEUVRES})

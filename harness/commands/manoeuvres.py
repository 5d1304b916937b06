"""--manoeuvre: those of the catalogue by their names, or files of the user's own."""

import json
from argparse import ArgumentTypeError
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from toolground.arguments import option, record
from toolground.errors import UserError
from toolground.known_names import nearest
from toolground.plain_text import plain

from ..loop.places import PLANTS
from ..manoeuvres.catalogue import MANOEUVRES
from ..manoeuvres.manoeuvre import Manoeuvre
from .options import names_or_files


class Chosen(NamedTuple):
    """What --manoeuvre says, once or several times.

    Attributes:
        manoeuvres: by their names, in the order in which they were given, each once.
        files: of those that are files.
    """

    manoeuvres: Mapping[str, Manoeuvre]
    files: Mapping[str, Path]

    @property
    def first(self) -> Manoeuvre:
        return next(iter(self.manoeuvres.values()))

    @property
    def digests(self) -> dict[str, Any]:
        """What distinguishes a run by the files of its manoeuvres; nothing if there are none."""
        found = {name: sha256(path.read_bytes()).hexdigest() for name, path in self.files.items()}
        return {"manoeuvre_files": found} if found else {}

    def with_torque(self, T_max: float) -> "Chosen":
        """These for a car whose motor has this largest torque in N.m; what is written in files stays as it is."""
        from ..manoeuvres.for_car import for_car

        each = self.manoeuvres.items()
        return self._replace(manoeuvres={name: m if name in self.files else for_car(m, T_max) for name, m in each})

    def beside(self, others: Mapping[str, Manoeuvre]) -> "Chosen":
        """These, then those of others that are not among them.

        Raises:
            UserError: another one has the name of one of these.
        """
        if same := next((name for name in self.files if name in others), None):
            raise UserError(f"two manoeuvres are called {same}; rename the file of one")
        return self._replace(manoeuvres={**self.manoeuvres, **others})


def chosen(texts: Iterable[str]) -> Chosen:
    """
    Args:
        texts: names of the catalogue and files.

    Raises:
        UserError: a file is refused; two manoeuvres have the same name.
    """
    found: dict[str, Manoeuvre] = {}
    for text in dict.fromkeys(texts):
        manoeuvre = MANOEUVRES[text] if text in MANOEUVRES else _of_file(Path(text))
        if found.setdefault(manoeuvre.name, manoeuvre) is not manoeuvre:
            raise UserError(f"two manoeuvres are called {manoeuvre.name}; rename the file of one")
    return Chosen(found, {Path(text).stem: Path(text) for text in texts if text not in MANOEUVRES})


def _of_file(path: Path) -> Manoeuvre:
    from ..manoeuvres.manoeuvre_file import read_manoeuvre

    return read_manoeuvre(path)


def _name_or_file(text: str) -> str:
    """A name of the catalogue, or what has an ending and so is a file."""
    if text not in MANOEUVRES and not Path(text).suffix:
        shown = plain(text, 60) or "an empty name"
        raise ArgumentTypeError(f"{shown} is unknown; {nearest(text, MANOEUVRES)} (or give a .toml or .csv file)")
    return text


def manoeuvre(help: str, default: str | None = None) -> Any:
    """--manoeuvre, of one manoeuvre with a default, or of several."""
    return option(
        default or (),
        help,
        _name_or_file,
        read=lambda given: chosen([given] if default else given),
        complete=names_or_files(tuple(MANOEUVRES), ("toml", "csv"), "manoeuvre"),
        metavar="NAME|FILE",
    )


@record
class Listing:
    """Of a command that takes --manoeuvre; `list` is answered before the command is called."""

    list: bool = option(False, "print the manoeuvres and exit")


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

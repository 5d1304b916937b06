"""Mutants of the files of the project, and a sample of them: by a seed, in proportion to the lines of the rooms."""

import os
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from tests.mutation import faults_in_c, faults_in_python

ROOT = Path(__file__).resolve().parents[2]

CODE = (
    *(f"{folder}/**/*.py" for folder in ("models", "fmus", "harness", "packages/*/src")),
    "packages/fmublocks/src/fmublocks/native/c/*.[ch]",
)
"""What is looked at; other C runs in no test that is compiled anew for each fault."""

DRAWING = re.compile(r"harness/views/|figures?\.py$|/layout\.py$|/picture\.py$|_html\.py$")
"""Files that draw: how thick a line is or how large a title is a choice, so that their numbers are not changed."""

NUMBER = re.compile(r"-?[\d.]+(e-?\d+)?")

LEAST = 2
"""Faults in a room, however small it is."""


class Mutant(NamedTuple):
    """In a line of a file, at the byte `place`, `new` stands for `old`."""

    file: str
    line: int
    place: int
    code: str
    old: str
    new: str

    @property
    def fault(self) -> str:
        return " ".join(f"{self.old} -> {self.new}".split())

    @property
    def known_as(self) -> tuple[str, str, str]:
        """Wherever the line moves."""
        return self.file, self.code, self.fault

    def lot(self, seed: int) -> bytes:
        """By which it is drawn, wherever it lies."""
        named = (str(seed), Path(self.file).name, self.code, self.fault)
        return sha256("\n".join(named).encode()).digest()

    @contextmanager
    def applied(self, folder: Path) -> Iterator[None]:
        """With the fault in the copy of the tree in a folder. The file then has a time of its own, so that nobody takes
        what was compiled of another version."""
        path, old = folder / self.file, self.old.encode()
        sound, when = path.read_bytes(), path.stat()
        end = self.place + len(old)
        if sound[self.place : end] != old:
            raise ValueError(f"{path} is not the file that {self} belongs to")
        try:
            path.write_bytes(sound[: self.place] + self.new.encode() + sound[end:])
            os.utime(path, (0, int(sha256(repr(self).encode()).hexdigest()[:7], 16)))
            yield
        finally:
            path.write_bytes(sound)
            os.utime(path, ns=(when.st_atime_ns, when.st_mtime_ns))


def not_copied(folder: str, names: list[str]) -> set[str]:
    """What is hidden or was made, but not the package docs.site."""
    made = {"build", "dist", "results", "site"} if Path(folder) == ROOT else set()
    return {name for name in names if name in made or name.startswith(".") or name.endswith(".egg-info")}


def mutants_of(file: str) -> list[Mutant]:
    """Those of a file that are known by different names, in the order of their places."""
    source = (ROOT / file).read_text(encoding="utf-8")
    faults = faults_in_python.faults if file.endswith(".py") else faults_in_c.faults
    found: dict[tuple[str, str, str], Mutant] = {}
    for place, old, new in sorted(set(faults(source))):
        line = source.encode()[:place].count(b"\n") + 1
        mutant = Mutant(file, line, place, source.splitlines()[line - 1].strip(), old, new)
        if not (DRAWING.search(file) and NUMBER.fullmatch(old)):
            found.setdefault(mutant.known_as, mutant)
    return list(found.values())


def rooms() -> dict[str, list[str]]:
    """Folder by folder, the files of the code."""
    found: dict[str, list[str]] = {}
    for path in (path for pattern in CODE for path in sorted(ROOT.glob(pattern))):
        if path.name != "__init__.py":
            file = path.relative_to(ROOT)
            found.setdefault(file.parent.as_posix(), []).append(file.as_posix())
    return found


def shares(lines: Mapping[str, int], size: int) -> dict[str, int]:
    """How many of `size` faults fall to each room: LEAST, and of the others its share by lines."""
    left = max(size - LEAST * len(lines), 0)
    exact = {room: left * count / sum(lines.values()) for room, count in lines.items()}
    rest = sorted(exact, key=lambda room: int(exact[room]) - exact[room])[: left - sum(map(int, exact.values()))]
    return {room: LEAST + int(exact[room]) + (room in rest) for room in lines}


def drawn(size: int, seed: int) -> list[Mutant]:
    """The faults of a sample, room by room; what is drawn of a room does not depend on the others."""
    files = rooms()
    lines = {room: sum((ROOT / file).read_bytes().count(b"\n") for file in names) for room, names in files.items()}
    return [
        mutant
        for room, count in shares(lines, size).items()
        for mutant in sorted((m for file in files[room] for m in mutants_of(file)), key=lambda m: m.lot(seed))[:count]
    ]

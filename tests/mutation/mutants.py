"""Mutants of the files of the project."""

import re
import sys
from pathlib import Path
from typing import NamedTuple

import faults_in_c
import faults_in_python

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT))  # for docs.studies

OF_NUMBERS = "models/block/integrator.py", "fmus/protocol.py"
"""Of these only the numbers that C takes from them are changed."""


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

    def apply(self, folder: Path) -> bytes:
        """Puts the fault into the copy of the tree in a folder, and returns the file as it was."""
        path, old = folder / self.file, self.old.encode()
        sound = path.read_bytes()
        end = self.place + len(old)
        if sound[self.place : end] != old:
            raise ValueError(f"{path} is not the file that {self} belongs to")
        path.write_bytes(sound[: self.place] + self.new.encode() + sound[end:])
        return sound


def mutants_of(file: str) -> list[Mutant]:
    """In the order of their places."""
    source = (ROOT / file).read_text(encoding="utf-8")
    faults = faults_in_python.faults if file.endswith(".py") else faults_in_c.faults
    found = []
    for place, old, new in sorted(set(faults(source))):
        line = source.encode()[:place].count(b"\n") + 1
        code = source.splitlines()[line - 1].strip()
        if file not in OF_NUMBERS or re.match(r"[A-Z_]+ = [\d.e-]+$", code):
            found.append(Mutant(file, line, place, code, old, new))
    return found

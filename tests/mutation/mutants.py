"""Mutants of the files of the project."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path
from runpy import run_path
from typing import NamedTuple

import faults_in_c
import faults_in_python

ROOT = Path(__file__).resolve().parents[2]

CODE = ("models", "fmus", "harness")
"""Folders whose Python is looked at."""


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


def mutants_of(file: str) -> list[Mutant]:
    """In the order of their places."""
    source = (ROOT / file).read_text(encoding="utf-8")
    faults = faults_in_python.faults if file.endswith(".py") else faults_in_c.faults
    found = []
    for place, old, new in sorted(set(faults(source))):
        line = source.encode()[:place].count(b"\n") + 1
        code = source.splitlines()[line - 1].strip()
        found.append(Mutant(file, line, place, code, old, new))
    return found


def code_files() -> list[str]:
    """Of Python, but for those that only say what a folder is."""
    paths = (path for folder in CODE for path in sorted((ROOT / folder).rglob("*.py")))
    return [str(path.relative_to(ROOT)) for path in paths if path.name != "__init__.py"]


def digest(file: str) -> str:
    """Of what a file computes, as the pages of the documentation know it: one that was only moved is the same."""
    return _digest(ROOT / file)


_digest = run_path(str(ROOT / "docs" / "studies" / "code_digest.py"))["digest"]
"""Not imported: tests that are run from here must find nothing of the tree imported."""

"""A sample of the faults that every room could have: by a seed, in proportion to the lines of the rooms."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from mutants import ROOT, Mutant, code_files, digest, mutants_of

PATH = ROOT / "tests" / "mutation" / "sample.json"

LEAST = 2
"""Faults in a room, however small it is."""


def rooms() -> dict[str, list[str]]:
    """Folder by folder, the files of the code."""
    found: dict[str, list[str]] = {}
    for file in code_files():
        found.setdefault(str(Path(file).parent), []).append(file)
    return found


def shares(lines: Mapping[str, int], size: int) -> dict[str, int]:
    """How many of `size` faults fall to each room: LEAST, and of the others its share by lines."""
    left = max(size - LEAST * len(lines), 0)
    exact = {room: left * count / sum(lines.values()) for room, count in lines.items()}
    rest = sorted(exact, key=lambda room: int(exact[room]) - exact[room])[: left - sum(map(int, exact.values()))]
    return {room: LEAST + int(exact[room]) + (room in rest) for room in lines}


def draw(size: int, seed: int) -> list[Mutant]:
    """The faults of a sample, room by room.

    What is drawn of a room does not depend on the others, nor on where in it a line stands.
    """
    files = rooms()
    lines = {room: sum(_lines(file) for file in names) for room, names in files.items()}
    return [
        mutant
        for room, count in shares(lines, size).items()
        for mutant in sorted(_each_once(files[room]), key=lambda mutant: _lot(mutant, seed))[:count]
    ]


def _lines(file: str) -> int:
    return len((ROOT / file).read_text(encoding="utf-8").splitlines())


def _each_once(files: list[str]) -> list[Mutant]:
    """The faults of files, those that are known by the same name once."""
    return list({mutant.known_as: mutant for file in files for mutant in reversed(mutants_of(file))}.values())


def _lot(mutant: Mutant, seed: int) -> bytes:
    named = (str(seed), Path(mutant.file).name, mutant.code, mutant.fault)
    return sha256("\n".join(named).encode()).digest()


Name = tuple[str, str, str]
"""What a fault is known as."""


@dataclass(frozen=True)
class Sample:
    """Which faults were drawn, and what has found them, kept in a file after each.

    Attributes:
        tried: the digest of the file as it was, and the test that has found the fault: None if no test has, empty if
            the code could not even be imported.
    """

    seed: int
    mutants: list[Mutant]
    tried: dict[Name, tuple[str, str | None]]

    @classmethod
    def drawn(cls, size: int, seed: int) -> "Sample":
        """With what is known of its faults."""
        mutants, (_, _, tried) = draw(size, seed), kept()
        names = {mutant.known_as for mutant in mutants}
        return cls(seed, mutants, {name: each for name, each in tried.items() if name in names})

    def is_found(self, mutant: Mutant) -> bool:
        """By a test, with the file as it is."""
        known, by = self.tried.get(mutant.known_as, ("", None))
        return by is not None and known == digest(mutant.file)

    def keep(self, mutant: Mutant, by: str | None) -> None:
        self.tried[mutant.known_as] = digest(mutant.file), by
        rows = [[*mutant.known_as, *self.tried.get(mutant.known_as, ())] for mutant in self.mutants]
        text = json.dumps({"seed": self.seed, "faults": rows}, indent=1, ensure_ascii=False)
        PATH.write_text(text + "\n", encoding="utf-8")


def kept() -> tuple[int, list[Name], dict[Name, tuple[str, str | None]]]:
    """Seed, faults that were drawn, and what is known of those that were tried."""
    if not PATH.exists():
        return 0, [], {}
    record = json.loads(PATH.read_text(encoding="utf-8"))
    names = [(file, line, fault) for file, line, fault, *_ in record["faults"]]
    tried = {name: tuple(row[3:]) for name, row in zip(names, record["faults"], strict=True) if row[3:]}
    return record["seed"], names, tried

"""The recording that a command reads: the file, and what its columns are called."""

from pathlib import Path
from typing import Any

from driverecords.arguments import Headings, recording
from toolground.arguments import record


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
        from toolground.digest import digest

        given = {"databases": self.dbc, "aliases": self.aliases}
        others = {name: [digest(path) for path in paths] for name, paths in given.items() if paths}
        cut = {name: each for name, each in (("from", self.from_), ("to", self.to)) if each is not None}
        return {"recording": digest(self.recording), "columns": dict(self.column), **others, **cut}

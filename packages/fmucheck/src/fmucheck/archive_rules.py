"""Rules for the archive of an FMU."""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import NamedTuple
from zipfile import ZipInfo

from fmuloop import fmu_archive
from fmuloop.limits import Limits

from .rule import OURS, Clause, Rule, Rules, Severity

PAGES = {
    ("documentation/index.html",): "the page that tools show",
    ("model.png", "documentation/diagram.png", "documentation/diagram.svg"): "the picture that tools show",
}
"""Where they are in FMI 2.0 or 3.0."""

EXTENSIONS = {".so", ".dll", ".dylib"}


class Archive(NamedTuple):
    """The archive of an FMU, what is in it, and what it may unpack to."""

    path: Path
    entries: list[ZipInfo]
    limits: Limits

    @property
    def names(self) -> list[str]:
        return [entry.orig_filename for entry in self.entries]


def _refusing(name: str, title: str, clause: Clause = OURS) -> Rule:
    """What `fmuloop.fmu_archive` refuses under that name."""

    def problems(fmu: Archive) -> Iterator[str]:
        problems_there = fmu_archive.problems(fmu.entries, fmu.limits)
        return (problem.text for problem in problems_there if problem.rule == name)

    return Rule(name, Severity.ERROR, title, clause, problems)


ZIP = Clause("2.3", "2.5.1")

REFUSING_RULES = (
    _refusing("archive-size", "the archive unpacks to no more than the limit"),
    _refusing("archive-entries", "the archive has no more entries than the limit"),
    _refusing("archive-description", "no description unpacks to more than the limit"),
    _refusing("archive-path", "no entry of the archive leads outside, or by a backslash", ZIP),
    _refusing("archive-link", "no entry of the archive is a link"),
    _refusing("archive-encrypted", "no entry of the archive is encrypted"),
    _refusing("archive-method", "the archive is packed as FMI asks", ZIP),
)

ARCHIVE_RULES = Rules()


@ARCHIVE_RULES.rule("archive-damaged", Severity.ERROR, "the archive is not damaged", ZIP)
def damaged(fmu: Archive) -> Iterator[str]:
    """Entries that do not unpack to what they were."""
    if damage := fmu_archive.damage(fmu.path):
        yield damage


@ARCHIVE_RULES.rule("archive-duplicate", Severity.WARNING, "no entry of the archive is there twice")
def duplicates(fmu: Archive) -> Iterator[str]:
    """Entries of the same name."""
    for name, count in sorted(Counter(fmu.names).items()):
        if count > 1 and not name.endswith("/"):
            yield f"{name} is there more than once"


@ARCHIVE_RULES.rule("archive-name", Severity.WARNING, "the names in the archive are plain ASCII")
def not_ascii(fmu: Archive) -> Iterator[str]:
    """Names that some hosts do not unpack as they are."""
    for name in fmu.names:
        if not (name.isascii() and name.isprintable()):
            yield f"{name} is not plain ASCII"


@ARCHIVE_RULES.rule("archive-binary", Severity.ERROR, "there is a binary, or there are the sources", ZIP)
def no_binary(fmu: Archive) -> Iterator[str]:
    """Whether anything can run."""
    binaries = {PurePosixPath(name).suffix for name in fmu.names if name.startswith("binaries/")}
    if not EXTENSIONS & binaries and not any(name.startswith("sources/") for name in fmu.names):
        yield "there is no binary for any platform, and there are no sources"


@ARCHIVE_RULES.rule("archive-leftover", Severity.NOTE, "nothing was left behind in the archive")
def leftovers(fmu: Archive) -> Iterator[str]:
    """Files that no host should find."""
    for name in fmu.names:
        if name.endswith(".pyc") or "__pycache__" in name.split("/"):
            yield f"{name} is a leftover of the Python that built it"


@ARCHIVE_RULES.rule("archive-pages", Severity.NOTE, "there are a page and a picture")
def no_pages(fmu: Archive) -> Iterator[str]:
    """What people look at first."""
    for places, why in PAGES.items():
        if not set(places).intersection(fmu.names):
            yield f"{' or '.join(places[:2])} is missing ({why})"

"""An FMU with its files in a folder that vanishes."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple, cast

import fmpy

from .call_trace import rest
from .errors import UnpackingError
from .fmu_archive import unpack
from .interface import Interface


class Unpacked(NamedTuple):
    """An FMU and the folder that has its files."""

    interface: Interface
    folder: str


@contextmanager
def unpacked(interface: Interface, folder: Path | None = None) -> Iterator[Unpacked]:
    """The FMU with its files, which vanish at the end.

    Args:
        folder: in which it is unpacked; None: that for temporary files.

    Raises:
        UnpackingError: it cannot be unpacked, or has no binary for this platform.
    """
    path = interface.path
    with TemporaryDirectory(prefix="fmuloop-", dir=folder, ignore_cleanup_errors=True) as files:
        rest()  # unpacking may take longer than a call may
        unpack(path, files)
        _find_binary(interface, Path(files, "binaries"))
        platforms = cast(list[str], fmpy.supported_platforms(files))
        if fmpy.platform not in platforms:
            has = ", ".join(platforms) or "none"
            raise UnpackingError(f"{path.name} has no binary for {fmpy.platform}; it has: {has}")
        yield Unpacked(interface, files)


def _find_binary(interface: Interface, binaries: Path) -> None:
    """Brings a binary that is in the folder of the other version of FMI to that of its own."""
    # FMUs of FMI 2.0 come with x86_64-linux, those of FMI 3.0 with linux64
    own, other = str(fmpy.platform), str(fmpy.platform_tuple)
    if interface.fmi == 3:
        own, other = other, own
    file = f"{interface.identifier}{fmpy.sharedLibraryExtension}"
    if not (binaries / own / file).exists() and (binaries / other / file).exists() and not (binaries / own).exists():
        (binaries / other).rename(binaries / own)

"""FMUs that are not ours, and ours after somebody has tampered with them."""

import sys
from collections.abc import Callable
from pathlib import Path
from zipfile import ZipFile

from pythonfmu.builder import FmuBuilder

DESCRIPTION = "modelDescription.xml"


RELAY = Path(__file__).with_name("relay.py")


def build_relay(folder: Path, script: Path = RELAY) -> Path:
    """Builds the FMU of relay.py, or of a changed copy, as anybody would with PythonFMU.

    The builder imports the script and leaves it there; the FMU of another copy would then run its code.
    """
    before = list(sys.path)
    sys.modules.pop(script.stem, None)
    try:
        return Path(FmuBuilder.build_FMU(script, dest=folder))
    finally:
        sys.modules.pop(script.stem, None)
        sys.path[:] = before


def tampered(fmu: Path, copy: Path, change: Callable[[str], str], **added: bytes) -> Path:
    """Copies an FMU with its model description changed and files added (path -> content)."""
    with ZipFile(fmu) as source, ZipFile(copy, "w") as target:
        for entry in source.infolist():
            content = source.read(entry)
            if entry.filename == DESCRIPTION:
                changed = change(content.decode("utf-8"))
                assert changed.encode("utf-8") != content or added, "nothing was changed"
                content = changed.encode("utf-8")
            target.writestr(entry, content)
        for path, content in added.items():
            target.writestr(path, content)
    return copy

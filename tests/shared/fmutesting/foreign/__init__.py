"""FMUs that are not ours, and ours after somebody has tampered with them."""

import re
import sys
from collections.abc import Callable
from pathlib import Path
from zipfile import ZipFile
from zlib import crc32

from pythonfmu.builder import FmuBuilder

DESCRIPTION = "modelDescription.xml"


RELAY = Path(__file__).with_name("relay.py")
CAR = Path(__file__).with_name("car.py")
SMALLEST_CONTROLLER = Path(__file__).with_name("smallest_controller.py")

UNITS = {
    "T_mot": "N.m", "T_brake": "N.m", "slope": "rad", "v_0": "m/s", "T_0": "N.m", "m": "kg", "omega_1": "rad/s",
    "omega_2": "rad/s", "omega_wheel_L": "rad/s", "omega_wheel_R": "rad/s", "T_gear": "N.m", "v": "m/s",
    "a_body": "m/s2",
}  # fmt: skip
"""Of the variables of car.py, if nothing else is said."""


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


def build_car(folder: Path, **theirs: tuple[str, str, float]) -> Path:
    """Builds the FMU of car.py.

    Args:
        theirs: name in the loop -> its name, its unit ("": none), and the factor of that unit to the SI.
    """
    folder.mkdir(exist_ok=True)
    names = {ours: (name, factor) for ours, (name, _, factor) in theirs.items()}
    # PythonFMU takes two scripts of one name in a process for the same
    script = folder / f"car_{crc32(repr(names).encode())}.py"
    script.write_text(CAR.read_text().replace("NAMES = {}", f"NAMES = {names!r}"))
    units = {name: unit for name, unit in UNITS.items() if name not in theirs}
    units |= {name: unit for name, unit, _ in theirs.values()}

    def with_units(xml: str) -> str:
        for name, unit in units.items():
            if unit:
                xml = re.sub(rf'(name="{re.escape(name)}"[^>]*>\s*<Real)', rf'\1 unit="{unit}"', xml)
        return xml

    return tampered(build_relay(folder, script), folder / "Theirs.fmu", with_units)


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

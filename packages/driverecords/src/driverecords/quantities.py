"""The quantities that a recording can hold, each declared once, and the names that files give them.

Nothing here is slow to import: help needs it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path

from toolground.known_names import nearest, words_of
from toolground.plain_text import plain
from toolground.toml_file import toml_entries

from .headings import key
from .source import RecordingError

OWN = Path(__file__).with_name("aliases.toml")

Aliases = Mapping[str, Sequence[str]]
"""Names by quantity; the first one is shown."""

BY_UNIT: Mapping[str, Sequence[str]] = {
    "time": (
        # where no other column is the time: a date beside `Time [s]` makes no two of it
        "Date",
        "Datum",
        "Datetime",
        "Datum Uhrzeit",
        "Datum Zeit",
        "Uhrzeit",
        "Index",
        "__index_level_0__",  # the index of a table of pandas
        "x",
        "",
    ),
    "v": ("GPS Speed",),
    "T_mot": ("T", "M"),
    "omega_1": ("Speed", "n"),
}
"""Names that leave open what they mean, by quantity: they count with a unit of it, where no column has a better one."""

PARTS = "v t speed torque drehmoment drehzahl couple height slope grade gradient valid counter alive"
OF_MANY = frozenset(PARTS.split())
"""Names, as `key` gives them, that mean this car only where no path stands before them: Brake/Torque is another."""

OTHERS = "max min limit request demand desired command cmd ref reference set setpoint target soll error wind trailer"
ANOTHER = frozenset((*OTHERS.split(), "lead", "rear", "front"))
"""Words of a path before a name: that it is no measured quantity of this car, or of a part of it."""


def is_of_another(path: str) -> bool:
    """Whether a path before a name tells that it is no measured quantity of this car."""
    # words in camel case too: RequestValues/Motor Torque was read as the torque
    return any(word.removesuffix("s") in ANOTHER for word in words_of(path))


STEPS = 3.0
"""Longest step of time that is no gap, in median steps, of what is sampled and not sent."""


@dataclass(frozen=True)
class Quantity:
    """A quantity of a recording, in SI units.

    Attributes:
        unit: of the SI, as in Modelica.
        file_unit: a unit in which files have it.
        limit: largest magnitude that a car can have.
        also: a second SI unit that files may have it in and that no factor converts into the first: wheel speeds are
            often given in m/s, and only the tyre radius makes rad/s of them, slopes in %, the tangent. Whoever reads it
            does that.
        slowest: longest interval in s from which a model can be identified.
        least_swing: by how much it must vary so that a model can be identified.
        gap: longest step of time that is still no gap, in median steps; messages come late and are lost.
        hole: longest time in s without a value that is filled, if it is longer than that of all.
    """

    meaning: str
    unit: str
    file_unit: str
    limit: float
    also: str | None = None
    slowest: float = inf
    least_swing: float = 0.0
    gap: float = STEPS
    hole: float = 0.0

    @property
    def held(self) -> bool:
        """Whether a value holds until the next, as those of messages do."""
        return STEPS < self.gap < inf


def _wheel_speed(meaning: str) -> Quantity:
    return Quantity(meaning, "rad/s", "km/h", 500.0, also="m/s", slowest=0.1, gap=10.0)


def _wheel_torque(meaning: str) -> Quantity:
    return Quantity(f"{meaning}, positive when it drives", "N.m", "Nm", 100_000.0, slowest=0.01, least_swing=20.0)


QUANTITIES: dict[str, Quantity] = {
    "time": Quantity("time", "s", "s", inf),
    "v": Quantity("speed of the vehicle", "m/s", "km/h", 200.0),
    "elevation": Quantity("height of the road", "m", "m", 10_000.0, gap=inf, hole=inf),
    "T_mot": Quantity("motor torque", "N.m", "Nm", 10_000.0, slowest=0.01, least_swing=2.0),
    "T_ref": Quantity(
        "motor torque as motor control is to make it", "N.m", "Nm", 10_000.0, slowest=0.1, least_swing=2.0, gap=10.0
    ),
    "T_driver": Quantity("motor torque that the driver demands", "N.m", "Nm", 10_000.0),
    "T_brake": Quantity("brake torque of the driven wheels", "N.m", "Nm", 100_000.0),
    "slope": Quantity("slope of the road, positive uphill", "rad", "%", 1.0, also="1"),
    "omega_1": Quantity("motor speed", "rad/s", "rpm", 5_000.0, slowest=0.01, least_swing=1.0),
    "omega_2": Quantity("wheel speed times i", "rad/s", "rad/s", 5_000.0, slowest=0.1, gap=10.0),
    "omega_wheel": _wheel_speed("mean speed of the driven wheels"),
    "omega_wheel_L": _wheel_speed("speed of the left driven wheel"),
    "omega_wheel_R": _wheel_speed("speed of the right driven wheel"),
    "valid": Quantity("whether the wheel speed on the bus is valid, 0 or 1", "1", "1", 1.0, gap=10.0),
    "counter": Quantity("one more with every message of the wheel speed", "1", "1", inf, gap=10.0),
    "alive": Quantity("one more with every frame of motor control", "1", "1", inf, gap=10.0),
    "slip_control": Quantity("whether a traction or brake control is active, 0 or 1", "1", "1", 1.0, gap=10.0),
    "T_load": Quantity(
        "load torque over i, negative when it brakes", "N.m", "Nm", 10_000.0, slowest=0.01, least_swing=2.0
    ),
    "T_wheel": _wheel_torque("torque of both measurement wheels"),
    "T_wheel_L": _wheel_torque("torque of the left measurement wheel"),
    "T_wheel_R": _wheel_torque("torque of the right measurement wheel"),
}


def aliases(*others: Path) -> Aliases:
    """The names of every quantity: ours, and then those of other files.

    Raises:
        RecordingError: a file cannot be read, or has something else; it gives two quantities one name.
    """
    names: dict[str, list[str]] = {quantity: [] for quantity in QUANTITIES}
    for path in (OWN, *others):
        for quantity, more in _read(path).items():
            names[quantity] += more
    taken: dict[str, str] = {}
    for quantity, spellings in names.items():
        for name in spellings:
            if taken.setdefault(key(name), quantity) != quantity:
                file = ", ".join(map(str, others))
                raise RecordingError(f"{file}: {plain(name, 60)} names both {taken[key(name)]} and {quantity}")
    return names


def _read(path: Path) -> dict[str, list[str]]:
    try:
        content = toml_entries(path)
    except ValueError as reason:
        raise RecordingError(f"{path}: {reason}") from reason
    for quantity, names in content.items():
        if quantity not in QUANTITIES:
            raise RecordingError(f"{path}: {plain(quantity, 60)} is no quantity; {nearest(quantity, QUANTITIES)}")
        if not (isinstance(names, list) and all(isinstance(name, str) and key(name) for name in names)):
            raise RecordingError(f'{path}: {quantity} = {plain(names, 60)}; it must be a list such as ["Motor Speed"]')
    return content


def example(quantity: str, names: Aliases) -> str:
    """A heading under which a file may have the quantity."""
    return f"{names[quantity][0]} [{QUANTITIES[quantity].file_unit}]"

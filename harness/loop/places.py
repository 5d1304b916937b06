"""The closed loop as data: its places, what stands in them, how they are connected, and what a run gives."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from fmuloop.system import Connection, Port
from toolground.errors import UserError

from ...fmus.names import COMPARATORS as COMPARATORS
from ...fmus.names import PLACES as PLACES
from ...fmus.names import T_S as T_S

_ROOT = Path(__file__).resolve().parents[2]

BUILD = (_ROOT if (_ROOT / "build_fmus.py").is_file() else Path()) / "build"
"""Where `driveline build` puts the FMUs: in the checkout; without one, in the working directory."""

NATIVE = "native"
"""Folder of the native builds, in that of the others."""

BUILDS = ("python", NATIVE)

BUILD_HELP = "native FMUs or those that run Python (default: native where all FMUs of the loop have that build)"
"""Of the option --build."""

PLANTS = PLACES["plant"]

NO_DAMPING = "NoDamping"
"""The controller that passes the demand through."""

STEP_SIZE = 1e-3
"""Communication step of the loop in s, unless another is asked for."""

NameOrFile = str | Path
"""What stands in a place: the name of one of the project's FMUs, or the path of an FMU."""

CONNECTIONS = (
    Connection("controller.T_ref", "motor.T_ref", "N.m"),
    Connection("motor.T_mot", "plant.T_mot", "N.m"),
    Connection("plant.omega_1", "motor.omega_1", "rad/s"),
    Connection("plant.omega_wheel_L", "can.omega_wheel_L", "rad/s"),
    Connection("plant.omega_wheel_R", "can.omega_wheel_R", "rad/s"),
    Connection("motor.omega_1_meas", "controller.omega_1_meas", "rad/s"),
    Connection("motor.T_mot_est", "controller.T_mot_est", "N.m"),
    Connection("can.omega_2_can", "controller.omega_2_can", "rad/s"),
    Connection("can.valid", "controller.valid"),
    Connection("can.counter", "controller.counter"),
)

OFFERED = (
    Connection("motor.alive", "controller.alive"),
    Connection("can.direction", "controller.direction"),
    Connection("can.slip_control", "controller.slip_control"),
)
"""What some buses tell, and ours does not."""

TRUTH = (
    Connection("plant.omega_1", "controller.omega_1", "rad/s"),
    Connection("plant.omega_2", "controller.omega_2", "rad/s"),
    Connection("plant.phi", "controller.phi", "rad"),
    Connection("plant.T_gear", "controller.T_gear", "N.m"),
)
"""What the comparator TrueMotion gets beside what is measured."""

INPUTS = (
    Port("controller.T_driver", "N.m"),
    Port("controller.enable", None),
    Port("plant.T_brake", "N.m"),
    Port("plant.slope", "rad"),
)

PARAMETERS = (Port("plant.v_0", "m/s"), Port("plant.T_0", "N.m"), Port("motor.seed", None), Port("can.seed", None))

OUTPUTS = (
    Port("controller.T_ref", "N.m"),
    Port("plant.omega_1", "rad/s"),
    Port("plant.omega_2", "rad/s"),
    Port("plant.T_gear", "N.m"),
    Port("plant.v", "m/s"),
    Port("plant.a_body", "m/s2"),
)

ROAD_LOAD = ("i", "r", "m", "g", "c_rr", "c_wa")
"""What the balance of forces along the road needs to know of a car: parameters of the plant."""

OPTIONAL: Mapping[str, float | None] = {
    "controller.enable": True,
    "controller.T_mot_est": None,
    "controller.omega_2_can": None,
    "controller.valid": None,
    "controller.counter": None,
    "motor.seed": None,
    "can.seed": None,
}
"""A controller need not use every measurement, and without `enable` it is always on; not every sensor has noise."""


def block_and_variable(name: str, blocks: Iterable[str]) -> tuple[str, str]:
    """The block and the variable in a name of the loop: one of `blocks`, whose names may have points, else what stands
    before the first one."""
    fallback = name.partition(".")[0]
    block = max((each for each in blocks if name.startswith(f"{each}.")), key=len, default=fallback)
    return block, name[len(block) + 1 :]


def by_name(blocks: Iterable[str], kind: str) -> dict[str, str]:
    """Blocks (names or files), each once, by the names that tables and files give them; `kind` says what they are.

    Raises:
        UserError: two have the same name, or a controller that of the run without damping.
    """
    named: dict[str, str] = {}
    for block in blocks:
        if named.setdefault(Path(block).stem, block) != block:
            raise UserError(f"two {kind}s are called {Path(block).stem}; rename the file of one")
    if kind == "controller" and "off" in named:
        raise UserError(f"the run without damping is called off, not a controller; rename the file {named['off']}")
    return named

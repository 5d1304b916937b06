"""The closed loop as data: its places, what stands in them, how they are connected, and what a run gives."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from ..base.errors import WiringError
from ..base.known_names import nearest
from ..cosimulation.limits import USUAL, Limits
from ..cosimulation.system import Connection, Port, System

_ROOT = Path(__file__).resolve().parents[2]

BUILD = (_ROOT if (_ROOT / "build_fmus.py").is_file() else Path()) / "build"
"""Where `driveline build` puts the FMUs: in the checkout; without one, in the working directory."""

NATIVE = "native"
"""Folder of the native builds, in that of the others."""

BUILDS = ("python", NATIVE)

BUILD_HELP = "native FMUs or those that run Python (default: native where all FMUs of the loop have that build)"
"""Of the option --build."""

COMPARATORS = ("NoDamping", "SpeedWashout", "SpeedDifference", "PaperObserver", "LinearObserver", "PerfectState")
"""Controllers that ours is compared with."""

# the torque of the motor does not depend on its speed, so it is stepped first and then known over the step
PLACES = {
    "motor": ("MotorTorqueLoop",),
    "controller": ("DampingController", *COMPARATORS),
    "can": ("WheelSpeedCan",),
    "plant": ("TwoMassDriveline", "ValidationVehicle"),
}
"""The places of the loop in the order in which they step, and the project's FMUs for each, the
first by default."""

PLANTS = PLACES["plant"]

STEP_SIZE = 1e-3
"""Communication step of the loop in s, unless another is asked for."""

T_S = 2e-3
"""Sample time of the controller in s."""

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

TRUTH = (
    Connection("plant.omega_1", "controller.omega_1", "rad/s"),
    Connection("plant.omega_2", "controller.omega_2", "rad/s"),
    Connection("plant.phi", "controller.phi", "rad"),
    Connection("plant.T_gear", "controller.T_gear", "N.m"),
)
"""What the comparator PerfectState gets beside what is measured."""

INPUTS = (
    Port("controller.T_driver", "N.m"),
    Port("controller.enable", None),
    Port("plant.T_brake", "N.m"),
    Port("plant.slope", "rad"),
)

PARAMETERS = (
    Port("plant.v_0", "m/s"),
    Port("plant.T_0", "N.m"),
    Port("motor.seed", None),
    Port("can.seed", None),
)

OUTPUTS = (
    Port("controller.T_ref", "N.m"),
    Port("plant.omega_1", "rad/s"),
    Port("plant.omega_2", "rad/s"),
    Port("plant.T_gear", "N.m"),
    Port("plant.v", "m/s"),
    Port("plant.a_body", "m/s2"),
)

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


def loop(
    plant: NameOrFile | None = None,
    folder: Path = BUILD,
    build: str | None = None,
    *,
    controller: NameOrFile | None = None,
    motor: NameOrFile | None = None,
    can: NameOrFile | None = None,
    mapping: Mapping[str, str] | None = None,
    limits: Limits = USUAL,
) -> System:
    """The closed loop: controller, motor, plant and the wheel speeds over CAN.

    Args:
        plant, controller, motor, can: one of PLACES, or the path of an FMU; None: the first of PLACES.
        folder: of the built FMUs.
        build: one of BUILDS; None: see `chosen_build`.
        mapping: what the loop calls `plant.T_gear` is `Shaft.tau` of the FMU in the place of the plant,
            see `harness.cosimulation.mapping`.
        limits: of FMUs that are given by their path.

    Raises:
        WiringError: there is no such block or build.
    """
    blocks = {"plant": plant, "controller": controller, "motor": motor, "can": can}
    files = _files(blocks, folder, build or _chosen_build(blocks, folder))
    return System(
        instances=files,
        connections=CONNECTIONS + (TRUTH if files["controller"].stem == "PerfectState" else ()),
        inputs=INPUTS,
        parameters=PARAMETERS,
        outputs=OUTPUTS,
        mapping=dict(mapping or {}),
        optional=OPTIONAL,
        own=frozenset(place for place, block in blocks.items() if block is None or str(block) in PLACES[place]),
        limits=limits,
    )


def chosen_build(
    plant: NameOrFile | None = None,
    folder: Path = BUILD,
    *,
    controller: NameOrFile | None = None,
    motor: NameOrFile | None = None,
    can: NameOrFile | None = None,
) -> str:
    """The build that runs if none is asked for: native where all FMUs of the loop have that build.

    Raises:
        WiringError: there is no such block.
    """
    return _chosen_build({"plant": plant, "controller": controller, "motor": motor, "can": can}, folder)


def _chosen_build(blocks: Mapping[str, NameOrFile | None], folder: Path) -> str:
    native = _files(blocks, folder, NATIVE)
    return NATIVE if all(path.is_file() for path in native.values()) else "python"


def _files(blocks: Mapping[str, NameOrFile | None], folder: Path, build: str) -> dict[str, Path]:
    if build not in BUILDS:
        raise WiringError(f"unknown build {build}; {nearest(build, BUILDS)}")
    if build == NATIVE:
        folder = folder / NATIVE
    return {place: _file(place, blocks[place], names, folder) for place, names in PLACES.items()}


def _file(place: str, block: NameOrFile | None, names: Sequence[str], folder: Path) -> Path:
    if block is None:
        block = names[0]
    if str(block) in names:
        return folder / f"{block}.fmu"
    path = Path(block)
    if path.suffix == ".fmu":
        return path
    name = str(block) or "(an empty name)"
    raise WiringError(f"unknown {place} {name}; {nearest(str(block), names)} (or give the path of a .fmu file)")

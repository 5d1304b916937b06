"""The loop as data: which FMUs there are, what is connected, and what a run gives and wants to see."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from ..errors import WiringError
from ..names import nearest

_ROOT = Path(__file__).resolve().parents[2]

BUILD = (_ROOT if (_ROOT / "build_fmus.py").is_file() else Path()) / "build"
"""Where `driveline build` puts the FMUs: in the checkout; without one, in the working directory."""

NATIVE = "native"
"""Folder of the native builds, in that of the others."""

BUILDS = ("python", NATIVE)

BUILD_HELP = "native FMUs or those that run Python (default: native where all FMUs of the loop have that build)"
"""Of the option --build."""

PLANTS = ("TwoMassDriveline", "ValidationVehicle")


class Connection(NamedTuple):
    """An output feeds an input; both are written `instance.variable`."""

    source: str
    target: str


class Signal(NamedTuple):
    """A variable that a run needs, `instance.variable`, and its unit (None: not a Real)."""

    name: str
    unit: str | None


@dataclass(frozen=True)
class System:
    """FMUs and how they are wired.

    Attributes:
        instances: name -> file of the FMU, in the order in which Gauss-Seidel steps them.
        connections: from outputs to inputs.
        inputs: what is fed from outside.
        parameters: what every run sets.
        outputs: what is evaluated after the run; other outputs are recorded too.
    """

    instances: Mapping[str, Path]
    connections: tuple[Connection, ...] = ()
    inputs: tuple[Signal, ...] = ()
    parameters: tuple[Signal, ...] = ()
    outputs: tuple[Signal, ...] = ()


CONNECTIONS = (
    Connection("controller.T_ref", "motor.T_ref"),
    Connection("motor.T_mot", "plant.T_mot"),
    Connection("plant.omega_1", "motor.omega_1"),
    Connection("plant.omega_wheel_L", "can.omega_wheel_L"),
    Connection("plant.omega_wheel_R", "can.omega_wheel_R"),
    Connection("motor.omega_1_meas", "controller.omega_1_meas"),
    Connection("motor.T_mot_est", "controller.T_mot_est"),
    Connection("can.omega_2_can", "controller.omega_2_can"),
    Connection("can.valid", "controller.valid"),
    Connection("can.counter", "controller.counter"),
)

INPUTS = (
    Signal("controller.T_driver", "N.m"),
    Signal("controller.enable", None),
    Signal("plant.T_brake", "N.m"),
    Signal("plant.slope", "rad"),
)

PARAMETERS = (
    Signal("plant.v_0", "m/s"),
    Signal("plant.T_0", "N.m"),
    Signal("motor.seed", None),
    Signal("can.seed", None),
)

OUTPUTS = (
    Signal("plant.omega_2", "rad/s"),
    Signal("plant.T_gear", "N.m"),
    Signal("plant.v", "m/s"),
    Signal("plant.a_body", "m/s2"),
)


def loop(plant: str | Path = PLANTS[0], folder: Path = BUILD, build: str | None = None) -> System:
    """The closed loop: controller, motor, the given plant and the wheel speeds over CAN.

    Args:
        plant: one of PLANTS, or the path of an FMU with the same interface.
        folder: of the built FMUs.
        build: one of BUILDS; None: see `chosen_build`.

    Raises:
        WiringError: there is no such plant or build.
    """
    return System(
        instances=_files(plant, folder, build or chosen_build(plant, folder)),
        connections=CONNECTIONS,
        inputs=INPUTS,
        parameters=PARAMETERS,
        outputs=OUTPUTS,
    )


def chosen_build(plant: str | Path = PLANTS[0], folder: Path = BUILD) -> str:
    """The build that runs if none is asked for: native where all FMUs of the loop have that build.

    Raises:
        WiringError: there is no such plant.
    """
    native = _files(plant, folder, NATIVE)
    return NATIVE if all(path.is_file() for path in native.values()) else "python"


def _files(plant: str | Path, folder: Path, build: str) -> dict[str, Path]:
    if build not in BUILDS:
        raise WiringError(f"unknown build {build}; {nearest(build, BUILDS)}")
    if build == NATIVE:
        folder = folder / NATIVE
    # of all orders this one comes nearest to the loop as one system: see docs/coupling.md
    return {
        "motor": folder / "MotorTorqueLoop.fmu",
        "controller": folder / "DampingController.fmu",
        "can": folder / "WheelSpeedCan.fmu",
        "plant": _plant_file(plant, folder),
    }


def _plant_file(plant: str | Path, folder: Path) -> Path:
    if plant in PLANTS:
        return folder / f"{plant}.fmu"
    path = Path(plant)
    if path.suffix == ".fmu":
        return path
    raise WiringError(f"unknown plant {plant}; {nearest(str(plant), PLANTS)} (or give the path of a .fmu file)")

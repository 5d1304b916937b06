"""A recorded drive through the simulated vehicle, as a program asks for it."""

from collections.abc import Sequence
from os import PathLike
from typing import Unpack

from driverecords.drive import Drive
from driverecords.findings import tell
from driverecords.plausibility import of_drive
from fmuloop.argument_kinds import require_each, require_kind
from toolground.errors import UserError

from ...loop.arguments import BLOCKS
from ...loop.mapped_names import mappings
from ...loop.places import PLACES, PLANTS, NameOrFile, by_name
from ...loop.resolved import resolve
from ...loop.settings import RunChanges, Settings
from ...manoeuvres.road_load import Track
from ...manoeuvres.speed_following import require_held
from .replay import Ride, car_of
from .replay import replay as rides
from .verdict import followed_speed


def replay(
    drive: Drive,
    plant: NameOrFile = PLANTS[1],
    controllers: Sequence[NameOrFile] = PLACES["controller"][:1],
    held: float | None = None,
    **changes: Unpack[RunChanges],
) -> list[Ride]:
    """Drives a vehicle with the torque demand of a recorded drive, once without damping and once with each controller.

    Brake and grade keep the simulated car at the recorded speed; they are the same for all. See also
    `driveline replay`.

        drive = driveline.read_drive(Path("my_trip.csv"))
        driveline.build_missing("ValidationVehicle", controller="SpeedWashout")  # not among those of `driveline build`
        rides = driveline.replay(drive, controllers=["DampingController", "SpeedWashout"])
        driveline.frame({ride.controller: ride.metrics for ride in rides})

    Args:
        drive: as `read_drive` reads it.
        plant: name of a plant of the project, or path of an FMU.
        controllers: names of controllers of the project, or paths of FMUs; the first is the one that is switched off.
        held: seconds for which the demand is sampled and held, a rougher foot; None: straight lines.
        changes: fields of the settings that are to be others, as of `compare`, for all rides.

    What makes the recording implausible is logged as warnings.

    Returns:
        The ride without damping, then one with each controller; signals in SI units, a row every 2 ms.

    Raises:
        UserError: there is no controller, or two have the same name; and what `simulate` raises.
        TypeError: a single controller is given.
        WiringError: `held` is less than a communication step, or the motor or plant lacks what the road load needs.
        MissingExtra: the extra `replay` is not installed.
    """
    if "controller" in changes:  # for scripts that no type checker reads
        raise TypeError("replay takes controllers, and no single controller")
    require_kind("drive", drive, Drive, "a Drive, as read_drive reads it")
    controllers = require_each("controllers", controllers, str | PathLike, BLOCKS)
    require_held(held)
    if not controllers:
        raise UserError("there is no controller to drive with; NoDamping is one too")
    named = by_name(map(str, controllers), "controller")
    common = Settings(plant).replace(**changes)
    mapped = mappings(common.mapping, [str(plant)], list(named.values()), common.limits)
    own = {name: mapped[str(plant), controller] for name, controller in named.items()}
    given = {name: resolve(common, controller=named[name], mapping=own[name]) for name in named}
    load, T_max = car_of(next(iter(given.values())))
    tell(of_drive(drive, load, T_max), drive.name)
    found = rides(Track.of(drive, T_max), load, given, held)
    if held is None:
        tell(followed_speed(drive, found), drive.name)
    return found

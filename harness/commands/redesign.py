"""What `driveline identify --design` does with a car: gains, the rebuilt controller, and what they are worth."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from shlex import quote
from typing import Any

from rich.table import Table

from toolground.printing import Printing

from ..loop.built_fmus import built_together
from ..loop.places import PLACES, PLANTS
from ..loop.settings import Settings
from .design import designed
from .options import write_toml


def compared_in() -> Settings:
    """Settings of the runs in which controllers are compared, whose FMUs are there then.

    Raises:
        UserError: they cannot be built.
    """
    return built_together(Settings(plant) for plant in PLANTS)[0]


def redesign(car: Path, vehicle: Mapping[str, Any], settings: Settings, replace: bool, out: Printing) -> Iterator[Path]:
    """Gains for the car of a vehicle file and the controller built with both, beside it; yields the paths.

    What the controller was before and what it is now on that car is printed.

    Args:
        vehicle: entries of the vehicle file that was known before.
        settings: of the runs in which controllers are compared.
        replace: whether other gains may be replaced.

    Raises:
        DesignError: there is no controller for this car.
        UserError: there are other gains.
        BuildError: the vehicle file has what the controller cannot be set to, or the controller cannot be built.
    """
    from ...fmus.building.builds import build_fmus
    from ...fmus.building.parameter_files import read_files, read_vehicle
    from ..design.design_weights import WEIGHTS
    from ..design.redesign import softened

    gains = car.with_name(f"{car.stem}_gains.toml")
    weights = softened(read_vehicle(car), vehicle, settings)
    if weights != WEIGHTS:
        share = weights.washout / WEIGHTS.washout
        out.say(
            f"washout at {share:.2f} of its frequency, for less overshoot in the mean than before: "
            "torque is withheld longer"
        )
    write_toml(designed(car, weights), gains, replace)
    yield gains
    yield from build_fmus([PLACES["controller"][0]], car.parent / f"{car.stem}_fmus", None, "host", car, gains)
    files = f"--vehicle {quote(str(car))} --parameters {quote(str(gains))}"
    out.say(f"to drive with them: driveline simulate {files} --output {quote(f'results/{car.stem}')}")
    if not out.silent:
        from toolground.tables import print_table

        print_table(_compared(read_files(car, None), vehicle, read_files(car, gains), settings))


def _compared(car: Mapping[str, Any], before: Mapping[str, Any], after: Mapping[str, Any], settings: Settings) -> Table:
    """The car, by the entries of its vehicle file, with what the controller assumed before and after."""
    from ..design.redesign import REDESIGN_MANOEUVRES, worth

    table = Table(title="settling time in ms and overshoot in %; each plant with what the vehicle file has of it")
    table.add_column("plant")
    table.add_column("manoeuvre")
    for what in ("settling", "overshoot"):
        for when in ("before", "after"):
            table.add_column(f"{what}\n{when}", justify="right")
    for plant in PLANTS:
        for manoeuvre in REDESIGN_MANOEUVRES:
            both = [worth(plant, manoeuvre, car, assumed, settings) for assumed in (before, after)]
            cells = [f"{1e3 * settling:.0f}" for settling, _ in both] + [f"{1e2 * over:.1f}" for _, over in both]
            table.add_row(plant, manoeuvre, *cells)
    return table

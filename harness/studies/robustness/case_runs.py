"""The loop of a case: a plant and a controller, with car and sensors as they were drawn."""

from collections.abc import Mapping
from functools import cache
from math import nan
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...base.errors import DrivelineError, SimulationError, UnpackingError
from ...base.plain_text import plain
from ...cosimulation.wiring import fit
from ...design.uncertainty_box import changed
from ...loop.places import PLACES
from ...manoeuvres.catalogue import MANOEUVRES
from ...metrics.evaluate import evaluate
from ...simulation.provenance import digest
from ...simulation.simulate import looped, simulate
from .draws import draw
from .outcome import METRICS, PEAK, Case, Outcome

Settings = Mapping[str, Any]
"""Arguments of `driveline.simulate` for a loop."""

Given = Mapping[tuple[str, str], tuple[str, Settings]]
"""By the names of plant and controller the plant (name or file) and the settings of the loop."""


class Loop(NamedTuple):
    """A plant with a controller.

    Attributes:
        plant: its name or file.
        settings: of its runs, with absolute paths, so that any process can make them.
        blocks: the parameters of each block by its place, as they are without a deviation.
        digests: of the FMUs.
    """

    plant: str
    settings: Settings
    blocks: Mapping[str, Mapping[str, float]]
    digests: Mapping[Path, str]


class CaseRunner:
    """Runs cases.

    Args:
        given: the loops.
        seed: of the draws.
    """

    def __init__(self, given: Given, seed: int) -> None:
        self.seed = seed
        self.loops = {key: _loop(*loop) for key, loop in given.items()}

    def results(self, case: Case, control: bool = True) -> np.ndarray:
        """The signals of a case.

        Args:
            control: whether the damping control is enabled.

        Raises:
            DrivelineError: an FMU is not the one that it is where the campaign was begun.
            SimulationError: see `driveline.simulate`.
        """
        loop, drawn = self.loops[case.plant, case.controller], draw(case.number, self.seed)
        for path, expected in loop.digests.items():
            _require(path, expected)
        settings = {**loop.settings, "parameters": loop.settings["parameters"] | changed(loop.blocks, drawn.deviation)}
        return simulate(MANOEUVRES[case.manoeuvre], loop.plant, control, **{**settings, "seed": drawn.noise})

    def outcome(self, case: Case) -> Outcome:
        """What came of a case; one that an FMU ends has no metrics.

        Raises:
            UnpackingError: an FMU cannot be unpacked or loaded on this machine.
        """
        try:
            results = self.results(case)
        except UnpackingError:
            raise  # that is the machine, and not the controller
        except SimulationError as reason:
            return Outcome(case, {metric.name: nan for metric in METRICS}, plain(reason))
        metrics = evaluate(results, MANOEUVRES[case.manoeuvre])
        peak = float(np.abs(results["plant.T_gear"]).max()) / self.T_max(case)
        return Outcome(case, {m.name: peak if m is PEAK else m.of(metrics) for m in METRICS})

    def T_max(self, case: Case) -> float:
        """The largest torque of the motor in N.m; without limit where its FMU does not say."""
        return self.loops[case.plant, case.controller].blocks["motor"].get("T_max", np.inf)


def _loop(plant: str, settings: Settings) -> Loop:
    system = looped(plant, settings)
    places = {place: _absolute(str(settings[place])) for place in PLACES if settings.get(place)}
    given = {**settings, **places, "folder": Path(settings["folder"]).absolute()}
    digests = {path.absolute(): digest(path) for path in system.instances.values()}
    return Loop(_absolute(plant), given, fit(system).parameters(settings["parameters"]), digests)


def _absolute(block: str) -> str:
    """A block by its name, or the whole path of an FMU."""
    return str(Path(block).absolute()) if Path(block).suffix == ".fmu" else block


def _require(path: Path, expected: str) -> None:
    if not path.is_file():
        raise DrivelineError(f"there is no FMU {path}; all that run cases need it at this path")
    status = path.stat()
    if _digest(path, status.st_mtime_ns, status.st_size) != expected:
        raise DrivelineError(f"{path} is not the one that the campaign was begun with")


@cache
def _digest(path: Path, modified: int, size: int) -> str:
    """Of a file, read again when it has been written."""
    return digest(path)

"""The pages and figures that are computed: how each is made, and what its numbers come from."""

import re
from collections.abc import Mapping
from itertools import product
from typing import NamedTuple

from driveline.harness.loop.places import PLACES, PLANTS


class Page(NamedTuple):
    """What is made at once.

    Attributes:
        name: of it in the table.
        steps: that make it, in their order: commands of `driveline`, or modules of which `make(folder, ...)` is
            called. OUT stands for the folder that they write to.
        writes: what is taken from there, by its place in docs; a * stands for the same on both sides.
        modules: that its numbers come from, beside the FMUs.
        fmus: the modules of those that run.
        files: patterns of data that it depends on too.
        allowed: an exit code of its steps that is no failure, beside 0.
        made_by: what makes it in the place of steps.
        scores: file with the digests of a page that knows them itself.
    """

    name: str
    steps: tuple[str, ...] = ()
    writes: Mapping[str, str] = {}
    own_modules: tuple[str, ...] = ()
    fmus: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    allowed: int = 0
    made_by: str = ""
    scores: str = ""

    @property
    def modules(self) -> tuple[str, ...]:
        """All that its numbers come from."""
        return self.own_modules + self.fmus

    @property
    def command(self) -> str:
        """What a reader calls to get it in the folder results."""
        commands = [step for step in self.steps if step.startswith("driveline ")]
        if not commands:
            return self.made_by or f"python -m docs.studies {self.name}"
        return re.sub(r" --output \S+| --replace| --quiet", "", commands[-1]).replace("OUT", "results")


def _same(*files: str) -> dict[str, str]:
    return {file: file for file in files}


LOOP = (
    *("fmus.two_mass_driveline", "fmus.validation_vehicle", "fmus.motor_torque_loop", "fmus.wheel_speed_can"),
    *("fmus.damping_controller", "fmus.native.packaging"),
)
COMPARED = (*LOOP, "fmus.comparators")


def _study(name: str, *more: str, figures: str = "", fmus: tuple[str, ...] = LOOP, files: str = "") -> Page:
    """A page that a module of this room makes, of that and more modules."""
    module = f"docs.studies.{name}_page"
    return Page(name, (module,), _same(f"{name}.md", *figures.split()), (module, *more), fmus, tuple(files.split()))


def _identification(table: str) -> Page:
    """A table of docs/identification.md."""
    module = "docs.studies.identification_page"
    return Page(f"identification_{table}", (f"{module} {table}",), _same("identification.md"), (module,), LOOP)


def _replay(trip: str, plant: str) -> str:
    """A recorded drive, with every controller that damps."""
    controllers = " ".join(f"--controller {name}" for name in PLACES["controller"] if name != "NoDamping")
    return (
        f"driveline replay ../shared/data/bmw_i3_trip_{trip}.csv --plant {plant} {controllers} "
        f"--output OUT/{trip}_{plant} --replace --quiet"
    )


def _fuzz(target: str, *more: str) -> Page:
    """A row of docs/reliability.md."""
    module = f"tests.fuzz.{target}"
    return Page(f"reliability_{target}", made_by=f"python -m tests.fuzz {target}", own_modules=(module, *more))


_ROWS = (
    _study("blocks", "fmus.description.documentation", fmus=()),
    _study("recordings", fmus=()),
    # any import moves a dot: only another order makes it stale
    Page("rooms", ("docs.studies.rooms",), {"figures/rooms.png": "rooms.png"}, ("docs.studies.rooms",)),
    Page(
        "results",
        ("driveline compare --output OUT/compare --replace", "docs.studies.results_page"),
        {"results.md": "results.md", "figures/drive.png": "compare/TwoMassDriveline_drive.png"},
        ("harness.studies.compare.compare",),
        LOOP,
    ),
    Page(
        "tutorial",
        ("docs.studies.tutorial_figures",),
        _same("figures/tutorial_*.png"),
        ("harness.studies.compare.compare",),
        LOOP,
        ("examples/cars/van.toml",),
    ),
    Page(
        "coupling",
        ("driveline study coupling --output OUT",),
        _same("coupling.md"),
        tuple(f"harness.studies.coupling.{name}" for name in ("coupling_page", "step_dependence")),
        LOOP,
    ),
    Page(
        "back_to_back",
        ("driveline study back-to-back --output OUT",),
        _same("back_to_back.md"),
        ("harness.studies.back_to_back.back_to_back_page",),
        (*LOOP, "fmus.python.packaging"),
    ),
    _study("design", files="examples/cars/*.toml"),
    _study("goals"),
    _study("vehicle_model"),
    _study("comparison", fmus=COMPARED),
    _study("roads", "docs.studies.grip_and_frames", fmus=(*COMPARED, "fmus.signal_faults")),
    Page(
        "target",
        ("driveline target record --output OUT --replace --quiet",),
        _same("target.md", "figures/target.png"),
        ("harness.exchange.target.target_page",),
        (*LOOP, "fmus.target.image"),
    ),
    Page(
        "analysis",
        ("driveline analyse --output OUT --replace --quiet",),
        _same("analysis.md", "figures/analysis_*.png"),
        ("harness.studies.margins.analysis_report",),
        LOOP,
    ),
    _study("calibration", figures="figures/calibration_*.png"),
    Page(
        "identification",
        (
            "driveline record --plant ValidationVehicle --output OUT/record --replace --quiet",
            "driveline identify OUT/record/ValidationVehicle_prbs_off.csv --output OUT/identify/identification.toml "
            "--replace --quiet",
        ),
        {"figures/identification_simulation.png": "identify/identification_simulation.png"},
        ("harness.simulation.excitation_drive", "harness.identification.identify"),
        LOOP,
    ),
    *map(_identification, ("accuracy", "vehicle", "traps", "foreign", "methods", "redesigned")),
    Page(
        "bound",
        ("driveline study bound --output OUT --replace --quiet",),
        _same("bound.md", "figures/bound.png"),
        ("harness.studies.bound.bound_report",),
        LOOP,
    ),
    Page(
        "faults",
        ("driveline faults --cases 10000 --output OUT --quiet",),
        _same("faults.md", "figures/faults.png", "figures/fault_pairs.png"),
        tuple(f"harness.studies.faults.{name}" for name in ("fault_report", "fault_campaign")),
        (*LOOP, "fmus.signal_faults"),
        allowed=1,  # a case is not clean
    ),
    Page(
        "robustness",
        ("driveline robustness --cases 300 --output OUT --quiet",),
        _same("robustness.md", "figures/robustness_*.png", "figures/worst_*.png"),
        tuple(f"harness.studies.robustness.{name}" for name in ("robustness_report", "robustness_campaign")),
        COMPARED,
    ),
    Page(
        "tuning",
        ("driveline design --search OUT/ours",),
        {"figures/front.png": "ours/front.png"},
        tuple(f"harness.design.search.{name}" for name in ("tune", "controller_cost")),
        LOOP,
    ),
    Page(
        "replay",
        (*(_replay(trip, plant) for trip, plant in product(("a01", "a11"), PLANTS)), "docs.studies.replay_page"),
        _same("replay.md"),
        ("harness.studies.drives.replay", "harness.recordings.drive"),
        COMPARED,
    ),
    Page("mutation", made_by="make mutation", scores="tests/mutation/score.json"),
    Page("speed", made_by="make bench", own_modules=("benchmarks.speed_page",), fmus=LOOP),
    _fuzz("calls", "fmus.native.packaging"),
    *map(_fuzz, ("archives", "plants", "recordings", "parameter_files")),
    _fuzz("swollen"),
    _fuzz("options", "harness.commands.cli", "harness.commands.options"),
)

PAGES = {page.name: page for page in _ROWS}
"""By their names; the cheap ones come first."""

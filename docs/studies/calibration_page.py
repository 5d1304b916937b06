"""docs/calibration.md, how to calibrate the controller."""

from pathlib import Path

from docs.studies.calibration import FACTOR, STANDSTILL, answered, cases, stiff_vehicle
from docs.studies.calibration_figure import plot_calibration
from docs.studies.calibration_tables import (
    COLUMNS,
    HEADINGS,
    LEAST,
    Found,
    cars,
    changes,
    fallback,
    nominal,
    rest,
    symptoms,
    unknown_and_known,
    value,
    without_effect,
)
from driveline.harness.design.uncertainty_box import Deviation
from driveline.harness.loop.places import PLANTS
from driveline.harness.simulation.many_runs import run_many
from driveline.harness.views.markdown import markdown_table
from driveline.harness.views.metrics_table import number

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")

PLANT = Path(__file__).with_name("calibration_page_plant.md").read_text(encoding="utf-8")


def page(found: Found) -> str:
    """The page as Markdown."""
    return PAGE.format(
        factor=FACTOR,
        least=f"{1e2 * LEAST:g}",
        standing=STANDSTILL.duration,
        symptoms=symptoms(found),
        silent=without_effect(found),
        plants="\n".join(_plant(found, plant) for plant in PLANTS).rstrip(),
        cars=markdown_table(["plant", "car", "manoeuvre", *HEADINGS], cars(found), labels=3),
        rest=rest(found),
        fallback=fallback(found),
        soft=unknown_and_known(found, Deviation(C=0.5), "settling_time"),
        wide=unknown_and_known(found, Deviation(phi_B=2.0), "overshoot"),
        stiff=unknown_and_known(found, Deviation(C=2.0), "overshoot"),
        stiffer=f"{number(value(found, stiff_vehicle(), 'overshoot'), COLUMNS['overshoot'])} %",
        slow=unknown_and_known(found, Deviation(tau=2.0), "response_delay"),
        slow_jerk=unknown_and_known(found, Deviation(tau=2.0), "jerk_rms"),
    )


def _plant(found: Found, plant: str) -> str:
    return PLANT.format(
        plant=plant,
        stem=figure_stem(plant),
        nominal=markdown_table(["manoeuvre", *HEADINGS], nominal(found, plant), labels=1),
        changes=markdown_table(["parameter", "manoeuvre", *HEADINGS], changes(found, plant), labels=2),
    )


def figure_stem(plant: str) -> str:
    return f"calibration_{plant}"


def make(folder: Path) -> None:
    todo = cases()
    found = dict(zip(todo, run_many(answered, todo), strict=True))
    for plant in PLANTS:
        plot_calibration(found, plant, folder / "figures" / figure_stem(plant))
    (folder / "calibration.md").write_text(page(found), encoding="utf-8")

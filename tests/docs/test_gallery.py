"""Every figure of the documentation is in the gallery, with a command that exists."""

import re

import pytest

from docs.site import gallery
from driveline.harness.commands.cli import parser
from tests.docs.pages import commands

FIGURES = sorted(path.name for path in gallery.FIGURES.iterdir())


@pytest.mark.parametrize("name", FIGURES)
def test_the_gallery_shows_every_figure(name: str) -> None:
    assert f"](figures/{name})" in gallery.page()


def test_it_shows_no_figure_that_is_not_there() -> None:
    assert set(re.findall(r"\(figures/([^)]+)\)", gallery.page())) == set(FIGURES)


def test_figures_whose_command_is_not_known_are_named() -> None:
    with pytest.raises(LookupError, match=r"docs/figures/new\.png"):
        gallery.command("new.png")


@pytest.mark.parametrize(
    ("figure", "made_by"),
    [
        ("drive.png", "driveline compare"),
        ("identification_simulation.png", "driveline identify results/record/ValidationVehicle_prbs_off.csv"),
        ("worst_ValidationVehicle_launch.png", "driveline robustness --cases 300"),
        ("calibration_TwoMassDriveline.png", "python -m docs.studies calibration"),
        ("loop.svg", ""),
    ],
)
def test_a_figure_has_the_command_that_a_reader_types(figure: str, made_by: str) -> None:
    assert gallery.command(figure) == made_by
    for arguments in commands(made_by):
        parser().parse_args(arguments)

"""Every figure of the documentation is in the gallery, with a command that exists."""

import re

import pytest

from docs.site import gallery
from driveline.harness.commands.cli import parser
from tests import ROOT
from tests.docs.pages import PAGES, commands, text_of

FIGURES = sorted(path.name for path in gallery.FIGURES.iterdir())


@pytest.mark.parametrize("name", FIGURES)
def test_the_gallery_shows_every_figure(name: str) -> None:
    assert f"](figures/{name})" in gallery.page()


def test_it_shows_no_figure_that_is_not_there() -> None:
    assert set(re.findall(r"\(figures/([^)]+)\)", gallery.page())) == set(FIGURES)


@pytest.mark.parametrize("made_by", sorted(set(gallery.MADE_BY.values()) - {gallery.BY_HAND}))
def test_its_commands_are_those_that_make_the_pages(made_by: str) -> None:
    assert made_by in (ROOT / "Makefile").read_text(encoding="utf-8") or any(made_by in text_of(page) for page in PAGES)
    for arguments in commands(made_by):
        parser().parse_args(arguments)


def test_figures_whose_command_is_not_known_are_named() -> None:
    with pytest.raises(LookupError, match=r"docs/figures/new\.png"):
        gallery.command("new.png")

"""Every figure of the documentation is in the gallery, with a command that exists."""

import re

import pytest

from docs.site import gallery

FIGURES = sorted(path.name for path in gallery.FIGURES.iterdir())


@pytest.mark.parametrize("name", FIGURES)
def test_the_gallery_shows_every_figure(name: str) -> None:
    assert f"](figures/{name})" in gallery.page()


def test_it_shows_no_figure_that_is_not_there() -> None:
    assert set(re.findall(r"\(figures/([^)]+)\)", gallery.page())) == set(FIGURES)


def test_figures_whose_command_is_not_known_are_named() -> None:
    with pytest.raises(LookupError, match=r"docs/figures/new\.png"):
        gallery.command("new.png")

"""The figures of studies as files; those that README and tutorial show are in git."""

from collections.abc import Iterator
from pathlib import Path

from PIL import Image

from driveline.harness.views.figure_options import FigureOptions
from driveline.harness.views.figure_style import draw

from . import data_file

FIGURES = data_file.ROOT / "docs" / "figures"

SHOWN = {
    "drive": ("results", "drive"),
    "tutorial_oscillation": ("tutorial", "oscillation"),
    "tutorial_damped": ("tutorial", "damped"),
    "tutorial_van": ("tutorial", "van"),
}
"""The pictures in docs/figures, with study and figure."""

COLOURS = 64
"""Of a picture in git: lines on white need no more."""


def draw_pictures() -> Iterator[Path]:
    """Draws the pictures of README and tutorial."""
    for name, (study, figure) in SHOWN.items():
        (path,) = draw(data_file.read(study).measured.figures[figure], FIGURES / name, FigureOptions(kinds=("png",)))
        with Image.open(path) as drawn:
            few = drawn.convert("RGB").quantize(COLOURS)
        few.save(path, optimize=True)
        yield path

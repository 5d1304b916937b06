"""Options of the figures, for all that draw them; nothing here is slow to import."""

from typing import NamedTuple

KINDS = {"png": "picture", "pdf": "for print, text in TrueType fonts", "svg": "for the web, text as outlines"}
"""The files that a figure can be, and what for."""

USUAL_KINDS = ("png",)


class FigureOptions(NamedTuple):
    """How figures are drawn.

    Attributes:
        caption: what was set, in small below.
        window: from and to when in s; None: what each figure shows by itself.
        kinds: of the files, some of KINDS; none: the figure is shown.
    """

    caption: str = ""
    window: tuple[float, float] | None = None
    kinds: tuple[str, ...] = USUAL_KINDS

    def clipped(self, start: float, end: float) -> tuple[float, float]:
        """The part of these times that the window shows."""
        return (max(self.window[0], start), min(self.window[1], end)) if self.window else (start, end)


PLAIN = FigureOptions()
"""No options."""

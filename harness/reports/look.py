"""What was asked of the figures, for whoever draws them; nothing here is slow to import."""

from typing import NamedTuple

KINDS = {
    "png": "picture",
    "pdf": "for print, text in TrueType fonts",
    "svg": "for the web, text as outlines",
}
"""The files that a figure can be, and what for."""

USUAL = ("png", "pdf")


class Look(NamedTuple):
    """How figures are drawn.

    Attributes:
        caption: what was set, in small below.
        window: from and to when in s; None: what each figure shows by itself.
        kinds: of the files, some of KINDS.
    """

    caption: str = ""
    window: tuple[float, float] | None = None
    kinds: tuple[str, ...] = USUAL

    def shown(self, start: float, end: float) -> tuple[float, float]:
        """What of this a figure shows."""
        return (max(self.window[0], start), min(self.window[1], end)) if self.window else (start, end)


PLAIN = Look()
"""Nothing was asked."""

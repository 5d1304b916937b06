"""Whether an FMU of the project was made from the sources that are here."""

from pathlib import Path

from fmublocks import origin

MODELS = Path(__file__).parents[1] / "models"
"""The equations of all of them."""


def sources_digest() -> str:
    """That of the sources of the FMUs, as they were when this was asked first."""
    return origin.sources_digest(MODELS)


def is_stale(path: Path) -> bool:
    """Whether an FMU was not made from the sources that are there; one of the user's own from those of fmublocks."""
    tells = origin.origin_of(path)
    return tells is None or tells.sources not in (sources_digest(), origin.sources_digest(None))

"""Small blocks, each in a Python file as a user of fmublocks writes it, and FMUs of them."""

from collections.abc import Iterator
from pathlib import Path

FOLDER = Path(__file__).parent


def build(folder: Path, *names: str, builds: str = "native", fmi: int = 2) -> dict[str, Path]:
    """FMUs of the blocks of these names; the native ones of FMI 2.0 alone lie in the folder itself."""
    return {path.stem: path for path in _built(folder, names, builds, fmi)}


def _built(folder: Path, names: tuple[str, ...], builds: str, fmi: int) -> Iterator[Path]:
    from fmublocks import build_fmus
    from fmublocks.own_file import fmu_in

    for path in build_fmus([fmu_in(FOLDER / f"{name}.py") for name in names], folder, builds, fmi=fmi):
        yield path.rename(folder / path.name) if builds == "native" else path

"""A controller in a Python file of the user's own: its FMU in the user's cache, with the file beside it, so that its
equations are found where the FMU runs."""

from functools import partial
from hashlib import sha256
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory

from fmublocks.own_file import fmu_in
from toolground.user_cache import kept, user_cache

from ...fmus.building.builds import build_fmus
from ...fmus.origin import sources_digest


def with_equations(controller: str) -> str:
    """A controller by its name, or where it is a Python file the path of its native FMU, of which
    `fmus.building.own_file.fmu_of` finds the equations.

    Raises:
        BuildError: the file declares no FMU, or it cannot be built.
        UserError: the cache cannot be written.
    """
    file = Path(controller)
    if file.suffix != ".py":
        return controller
    name = fmu_in(file).name
    made_from = sha256(f"{sources_digest()}{file.read_text(encoding='utf-8')}".encode()).hexdigest()[:32]
    folder = user_cache() / "controllers" / made_from
    kept(folder / f"{name}.py", partial(copyfile, file))
    return str(kept(folder / f"{name}.fmu", partial(_build, file)))


def _build(file: Path, path: Path) -> None:
    with TemporaryDirectory() as folder:
        (made,) = build_fmus([str(file)], Path(folder), "native")
        copyfile(made, path)

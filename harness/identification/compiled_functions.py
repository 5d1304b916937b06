"""A function of CasADi as machine code, which is ten times as fast. It is kept for the next time, since compiling takes
seconds."""

import logging
import os
import shutil
import subprocess
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory

import casadi as ca

from ...fmus.child_process import run
from ..base.user_cache import forget, user_cache

FLAGS = ("-shared", "-fPIC", "-O1", "-ffp-contract=off")
"""Each operation rounds on its own, as in CasADi."""

_log = logging.getLogger(__name__)


def compiled(function: ca.Function) -> ca.Function:
    """The same function with the same results; itself where there is no C compiler (the environment variable CC can
    name one) or its code cannot be kept."""
    compiler = os.environ.get("CC", "cc")
    if shutil.which(compiler) is None:
        return function
    generator = ca.CodeGenerator(f"{function.name()}.c")
    generator.add(function)
    source = generator.dump()
    key = sha256("\n".join([source, compiler, *FLAGS]).encode()).hexdigest()
    folder = user_cache() / "functions" / key[:32]
    library = folder / f"{function.name()}.so"
    try:
        if not _whole(library):
            _compile(source, compiler, library)
        os.utime(folder)  # it has been used
        forget(folder.parent.iterdir())
        return ca.external(function.name(), str(library))
    except (OSError, subprocess.CalledProcessError, RuntimeError) as error:
        _log.info("%s is not compiled, which makes it slower: %s", function.name(), error)
        return function


def _compile(source: str, compiler: str, library: Path) -> None:
    library.parent.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(dir=library.parent) as folder:
        written, made = Path(folder) / "source.c", Path(folder) / library.name
        written.write_text(source, encoding="utf-8")
        run([compiler, *FLAGS, str(written), "-o", str(made), "-lm"], Path(folder)).check_returncode()
        made.replace(library)
    _sum(library).write_text(sha256(library.read_bytes()).hexdigest(), encoding="utf-8")


def _whole(library: Path) -> bool:
    """Whether it is there as it was made: one that is cut off would end the process that loads it."""
    if not (library.is_file() and _sum(library).is_file()):
        return False
    return _sum(library).read_text(encoding="utf-8", errors="replace") == sha256(library.read_bytes()).hexdigest()


def _sum(library: Path) -> Path:
    return library.with_suffix(".sha256")

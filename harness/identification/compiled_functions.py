"""A function of CasADi as machine code, which is ten times as fast. It is kept for the next time, since compiling takes
seconds."""

import logging
import os
import shutil
import subprocess
from functools import partial
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory

import casadi as ca

from toolground.child_process import run
from toolground.user_cache import kept, user_cache

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
    library = user_cache() / "functions" / key[:32] / f"{function.name()}.so"
    try:
        return ca.external(function.name(), str(kept(library, partial(_compile, source, compiler))))
    except (OSError, subprocess.CalledProcessError, RuntimeError) as error:
        _log.info("%s is not compiled, which makes it slower: %s", function.name(), error)
        return function


def _compile(source: str, compiler: str, library: Path) -> None:
    with TemporaryDirectory() as folder:
        written = Path(folder) / "source.c"
        written.write_text(source, encoding="utf-8")
        run([compiler, *FLAGS, str(written), "-o", str(library), "-lm"], Path(folder)).check_returncode()

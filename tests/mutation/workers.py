"""Workers that try mutants, each in a copy of the tree of its own."""

import math
import os
import pickle
import re
import resource
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from hashlib import md5
from multiprocessing import get_context
from pathlib import Path
from typing import Any

# slow to import and needed by every run of the tests, which inherits them
import casadi  # noqa: F401
import fmpy.fmi2  # noqa: F401
import matplotlib.backends.backend_agg  # noqa: F401
import pytest
from hypothesis import Phase, settings
from mutants import ROOT, Mutant

settings.register_profile("mutation", deadline=None, derandomize=True, phases=(Phase.explicit, Phase.generate))

OPTIONS = "-x", "-q", "-p", "no:cacheprovider", "--hypothesis-profile=mutation"

MEMORY = Path("/dev/shm")
"""Faster than a disk, where there is one: each run unpacks hundreds of FMUs."""

Tests = tuple[str, ...]

TIME_LIMIT = 10
"""Of computing in a test, in s: a mutant that needs more does not end, and is found."""

COMPILER = """#!/bin/sh
# cc that compiles a file again only when it, what it includes or an option has changed
while [ $# -gt 0 ]; do
    case $1 in
    -o) output=$2; shift ;;
    *.c)
        key=$( (echo "$options"; cc $options -E -P "$1") 2>/dev/null | md5sum | cut -c1-32)
        object=OBJECTS/$key.o
        [ -f "$object" ] || cc $options -O0 -c "$1" -o "$object$$" || exit 1
        [ -f "$object" ] || mv "$object$$" "$object"
        objects="$objects $object" ;;
    *) options="$options $1" ;;
    esac
    shift
done
exec cc $objects $options -o "$output"
"""


def prepare(folder: str) -> None:
    """Gives this worker a copy of the tree to work in."""
    copy = Path(folder, str(os.getpid()))
    ours = shutil.ignore_patterns(".*", "build", "results", "__pycache__", "*.egg-info")
    shutil.copytree(ROOT, copy, ignore=ours)
    objects, compiler = copy / "objects", copy / "cc"
    objects.mkdir()
    (copy / "kept").mkdir()
    (copy / "temporary").mkdir()
    os.environ["TMPDIR"] = str(copy / "temporary")
    tempfile.tempdir = None
    compiler.write_text(COMPILER.replace("OBJECTS", str(objects)))
    compiler.chmod(stat.S_IRWXU)
    os.environ["CC"] = str(compiler)
    os.chdir(copy)
    sys.path[0] = str(copy)


class TimeLimit:
    """Ends the process, or the program that it waits for, when a test computes for too long."""

    def pytest_runtest_setup(self) -> None:
        used = resource.getrusage(resource.RUSAGE_SELF)
        limit = math.ceil(used.ru_utime + used.ru_stime) + TIME_LIMIT
        resource.setrlimit(resource.RLIMIT_CPU, (limit, resource.RLIM_INFINITY))


class Remembered:
    """What no fault in the C core changes is computed once by a worker: traced sources, pages, what is in the FMUs
    that run Python."""

    def pytest_configure(self) -> None:
        from driveline.fmus.native import packaging as native
        from driveline.fmus.python import packaging as python

        native.block_sources = remembered(native.block_sources)
        native.documentation = remembered(native.documentation)
        python.documentation = remembered(python.documentation)
        python._resources_and_binaries = remembered(python._resources_and_binaries)


def remembered(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function of an FMU and other arguments, its results kept in files."""

    def result(fmu: Any, *others: Any) -> Any:
        starts = [record._field_defaults for record in (fmu.block.Parameters, fmu.block.Input)]
        asked = re.sub(" at 0x[0-9a-f]+", "", repr((function.__module__, function.__name__, fmu, starts, others)))
        kept = Path("kept", md5(asked.encode(), usedforsecurity=False).hexdigest())
        if not kept.exists():
            kept.write_bytes(pickle.dumps(function(fmu, *others)))
        return pickle.loads(kept.read_bytes())

    return result


def passes(tests: Tests, in_c: bool = False) -> bool:
    """Whether the tests pass here; in a process of its own, which has imported nothing of the tree.

    Args:
        in_c: no Python file has changed.
    """
    child = os.fork()
    if child == 0:
        result = 1
        try:
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, 1)
            os.dup2(nowhere, 2)
            plugins = [TimeLimit(), Remembered()] if in_c else [TimeLimit()]
            sys.dont_write_bytecode = not in_c
            result = pytest.main([*OPTIONS, *tests], plugins=plugins)
        finally:
            os._exit(result)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def survives(mutant: Mutant, tests: Tests) -> bool:
    sound = mutant.apply(Path())
    try:
        return passes(tests, in_c=not mutant.file.endswith(".py"))
    finally:
        Path(mutant.file).write_bytes(sound)


def survivors(mutants: list[Mutant], tests_of: Mapping[str, Tests]) -> Iterator[Mutant]:
    """Those that no test finds; tells how far it is.

    Args:
        tests_of: by the file that is mutated, in the order in which they are run.
    """
    with (
        tempfile.TemporaryDirectory(dir=MEMORY if MEMORY.exists() else None) as folder,
        ProcessPoolExecutor(mp_context=get_context("fork"), initializer=prepare, initargs=(folder,)) as workers,
    ):
        used = list(dict.fromkeys(tests_of[mutant.file] for mutant in mutants))
        for tests, good in zip(used, workers.map(passes, used), strict=True):
            if not good:
                sys.exit(f"without any fault the tests fail: {' '.join(tests)}")
        results = workers.map(survives, mutants, [tests_of[mutant.file] for mutant in mutants])
        for n, (mutant, alive) in enumerate(zip(mutants, results, strict=True), start=1):
            print(f"{n} of {len(mutants)}", end="\r", flush=True)
            if alive:
                print(f"{mutant.file}:{mutant.line}: {mutant.fault}", flush=True)
                yield mutant

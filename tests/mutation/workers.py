"""Workers that try mutants, each in a copy of the tree of its own."""

import ctypes
import math
import os
import resource
import select
import shutil
import signal
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from runpy import run_path

# slow to import and needed by every run of the tests, which inherits them
import casadi  # noqa: F401
import fmpy.fmi2  # noqa: F401
import matplotlib.backends.backend_agg  # noqa: F401
import pandas  # noqa: F401
import pytest
import scipy.signal  # noqa: F401
from fmutesting import compiling
from hypothesis import Phase, settings

from tests.mutation.mutants import ROOT, Mutant, not_copied
from tests.mutation.remembering import Remembered

settings.register_profile("mutation", deadline=None, derandomize=True, phases=(Phase.explicit, Phase.generate))

OPTIONS = "-x", "-q", "-p", "no:cacheprovider", "--hypothesis-profile=mutation"

MEMORY = Path("/dev/shm")
"""Faster than a disk, where there is one: each run unpacks hundreds of FMUs."""

SOUND: set[str] = set()
"""Tests that are known by this worker to pass without a fault."""

UNSOUND: set[str] = set()
"""Tests that are known by this worker to fail without a fault."""

TIME_LIMIT = 20
"""Of computing in a test, in s: a mutant that needs more does not end, and is found."""

TEST_WAITED = 180
"""Time in s after which a test does not end, whatever it waits for."""

WAITED = 300.0
"""Time in s for the tests of a round; those that are not run until then do not find the fault."""

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
"""Of prctl(2)."""

RUNNING = ("harness", *(f"packages/{name}/" for name in ("driverecords", "fmuloop", "fmucheck")))
"""Folders of what FMUs are not made of."""

Task = tuple[Mutant, Sequence[Sequence[str]], Sequence[str]]
"""A mutant, tests of which the fast ones are run, in rounds, and tests of which the slow ones are run after them."""


def prepare(folder: str) -> None:
    """Gives this worker a copy of the tree to work in."""
    own = Path(folder, str(os.getpid()))
    copy, temporary, compiled = (own / name for name in ("tree", "temporary", "compiled"))  # tests write outside of it
    shutil.copytree(ROOT, copy, ignore=not_copied, symlinks=True)
    for made in (temporary, compiled):
        made.mkdir()
    os.environ["TMPDIR"] = str(temporary)
    tempfile.tempdir = None
    os.environ["CC"] = str(run_path(compiling.__file__)["caching_compiler"](compiled) or "cc")
    os.chdir(copy)
    folders = [str(copy), str(copy / "tests/shared"), *map(str, copy.glob("packages/*/src"))]
    os.environ["PYTHONPATH"], sys.path[:1] = os.pathsep.join(folders), folders
    os.environ["PYTHONDONTWRITEBYTECODE"], sys.dont_write_bytecode = "", False  # each run imports the same
    _prctl(PR_SET_CHILD_SUBREAPER, 1)
    _prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def _prctl(option: int, value: int) -> None:
    ctypes.CDLL(None).prctl(option, value, 0, 0, 0)


class Watched:
    """Plugin that keeps which test is running, and ends the process, or the program that it waits for, when a test
    computes or waits for too long."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        self.path.write_text(nodeid, encoding="utf-8")

    def pytest_runtest_setup(self) -> None:
        signal.alarm(TEST_WAITED)
        used = resource.getrusage(resource.RUSAGE_SELF)
        limit = math.ceil(used.ru_utime + used.ru_stime) + TIME_LIMIT
        resource.setrlimit(resource.RLIMIT_CPU, (limit, resource.RLIM_INFINITY))


def failing(tests: Sequence[str], same_fmus: bool = False) -> str | None:
    """The first of the tests that does not pass here, empty if they cannot even be collected; None if all pass, as far
    as they are run within WAITED. In a process of its own, which has imported nothing of the tree; nothing that it
    has started is left running.

    Args:
        tests: and options of pytest.
        same_fmus: the FMUs are those of the tree, but for their C core.
    """
    running = Path(tempfile.gettempdir(), "running")
    plugins = [Watched(running), *([Remembered(running.parent.with_name("kept"))] if same_fmus else [])]
    running.write_text("", encoding="utf-8")
    child = os.fork()
    if child == 0:
        result = 1
        try:
            os.setsid()
            _prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
            nowhere = os.open(os.devnull, os.O_RDWR)
            for stream in range(3):
                os.dup2(nowhere, stream)
            result = pytest.main([*OPTIONS, *tests], plugins=plugins)
        finally:
            os._exit(result)
    end = os.pidfd_open(child)
    has_ended, _, _ = select.select([end], [], [], WAITED)
    os.close(end)
    os.kill(child, signal.SIGKILL)  # does nothing to one that has ended
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    _end_children()
    passed = not has_ended or code in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)
    return None if passed else running.read_text(encoding="utf-8")


def _end_children() -> None:
    """Those of processes that have ended are children of this one, whatever group or session they are in."""
    children = Path(f"/proc/self/task/{os.getpid()}/children")
    while found := children.read_text(encoding="ascii").split():
        for child in map(int, found):
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)


def finder(mutant: Mutant, rounds: Sequence[Sequence[str]], slow: Sequence[str]) -> str | None:
    """The first test that finds a fault; None if none does. Tests that fail without it are left out."""
    for marker, some in (*(("not slow", tests) for tests in rounds), ("slow", slow)):
        if some and (found := _finder(mutant, ["-m", marker, *some])) is not None:
            return found
    return None


def _finder(mutant: Mutant, tests: Sequence[str]) -> str | None:
    same_fmus = mutant.file.startswith(RUNNING) or not mutant.file.endswith(".py")
    while True:
        left = [*tests, *(f"--deselect={test}" for test in UNSOUND)]
        with mutant.applied(Path()):
            found = failing(left, same_fmus)
        if found is None or found in SOUND:
            return found
        if failing([found] if found else ["--collect-only", *left], same_fmus) is None:
            if found:
                SOUND.add(found)
            return found
        print(f"{found or ' '.join(tests)} fails here without any fault, and finds none", flush=True)
        if not found:
            return None
        UNSOUND.add(found)


def finders(tasks: Iterable[Task], number: int) -> Iterator[tuple[Mutant, str | None]]:
    """Each of the faults with what finds it, as soon as that is known, by so many workers in copies of the tree."""
    with (
        tempfile.TemporaryDirectory(dir=MEMORY if MEMORY.exists() else None) as folder,
        ProcessPoolExecutor(number, get_context("fork"), prepare, (folder,)) as workers,
    ):
        running = {workers.submit(finder, *task): task[0] for task in tasks}
        yield from ((running[done], done.result()) for done in as_completed(running))

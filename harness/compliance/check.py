"""Whether an FMU keeps the FMI 2.0 standard for Co-Simulation, and our rules beyond it."""

import tempfile
from collections.abc import Callable, Iterable, Iterator
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from ..cosimulation.interface import Interface
from ..errors import DrivelineError
from . import archive_rules, behaviour_rules, description_rules

TIME_LIMIT = 300.0
"""Seconds after which a behaviour counts as hanging."""


class Check(NamedTuple):
    """A rule and the function that lists what breaks it."""

    title: str
    problems: Callable[[Path], Iterable[str]]


class Verdict(NamedTuple):
    """What a check found: nothing, if the FMU keeps the rule."""

    title: str
    problems: list[str]


FILE_CHECKS = (
    Check("archive is portable and complete", archive_rules.archive),
    Check("model description is valid (fmpy)", description_rules.standard),
    Check("variables have units, bounds and descriptions", description_rules.variables),
    Check("model structure tells dependencies", description_rules.structure),
    Check("experiment and origin are given", description_rules.experiment),
)

BEHAVIOUR_CHECKS = (
    Check("default experiment runs, outputs are finite", behaviour_rules.default_experiment),
    Check("steps of any size are accepted, if it claims so", behaviour_rules.any_step_size),
    Check("a second run after reset is the same", behaviour_rules.repeats_after_reset),
    Check("two instances do not see each other", behaviour_rules.instances_are_separate),
    Check("saved states are restored, if it claims so", behaviour_rules.states_are_restored),
)


def check(path: Path) -> Iterator[Verdict]:
    """Checks an FMU, one verdict after the other, the first being whether it can be read at all.

    Each behaviour is tried in a process of its own: an FMU may crash its host, and the host must
    end with exit code 0.

    Raises:
        DrivelineError: there is no such file.
    """
    if not path.is_file():
        raise DrivelineError(f"there is no FMU {path}")
    title = "it is an FMI 2.0 Co-Simulation FMU"
    unreadable = _attempt(_readable, path)
    yield Verdict(title, unreadable)
    if unreadable:
        return
    for title, problems in FILE_CHECKS:
        yield Verdict(title, _attempt(problems, path))
    for title, problems in BEHAVIOUR_CHECKS:
        yield Verdict(title, _isolated(problems, path))


def _readable(path: Path) -> Iterable[str]:
    Interface(path)
    return ()


def _attempt(problems: Callable[[Path], Iterable[str]], path: Path) -> list[str]:
    """Problems, one of which may be that the FMU cannot be read or refuses a call."""
    found: list[str] = []
    try:
        found.extend(problems(path))
    except DrivelineError as error:
        found.append(str(error))
    return found


def _isolated(problems: Callable[[Path], Iterable[str]], path: Path) -> list[str]:
    context = get_context("spawn")
    receiver, sender = context.Pipe(duplex=False)
    # of a host that crashes nothing else would remove what it has unpacked
    with TemporaryDirectory(prefix="driveline-", ignore_cleanup_errors=True) as folder:
        host = context.Process(target=_host, args=(problems, path, folder, sender))
        host.start()
        sender.close()
        try:
            found = receiver.recv() if receiver.poll(TIME_LIMIT) else [f"no end after {TIME_LIMIT:g} s"]
        except EOFError:
            found = []
        host.join(10.0)
        if host.is_alive():
            host.kill()
            host.join()
    if host.exitcode:
        found.append(f"its host process ended with exit code {host.exitcode}")
    return found


def _host(problems: Callable[[Path], Iterable[str]], path: Path, folder: str, sender: Any) -> None:
    tempfile.tempdir = folder
    sender.send(_attempt(problems, path))
    sender.close()

"""The controller on the target beside the same C on this machine: sample by sample off-line, and in the loop."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from fmublocks.target.image import build_on_target
from fmublocks.target.link import Answer, Link

from ....fmus.catalogue import CONTROLLERS
from ...loop import roles
from ...loop.resolved import ResolvedLoop
from ...manoeuvres.catalogue import USUAL_MANOEUVRES
from ...manoeuvres.for_car import for_car
from ...metrics.evaluate import at_samples
from ...simulation.simulate import simulate
from .controllers import Programs
from .offline_cases import Case, fed

ABSOLUTE, RELATIVE = 1e-3, 1e-4
"""How far T_ref in single precision may be from that in double: in N.m, and over the torque."""


class Comparison(NamedTuple):
    """A case on the target and on this machine.

    Attributes:
        samples: of the case.
        differing: those in which a bit of the outputs or of the state differs from the same C in single precision.
        T_ref, T_gear_hat: in N.m, largest distance from double precision.
        margin: of T_ref, over what it may be.
        largest: in N.m, of T_ref.
        instructions: mean and most of a sample.
        stack: bytes.
        finite: whether all outputs are.
        traces: T_ref on the target and in double precision, N.m.
        states: on the target, a row a sample.
    """

    case: Case
    samples: int
    differing: int
    T_ref: float
    T_gear_hat: float
    margin: float
    largest: float
    instructions: tuple[float, int]
    stack: int
    finite: bool
    traces: tuple[np.ndarray, np.ndarray]
    states: np.ndarray


def responses(link: Link, case: Case) -> list[Answer]:
    """What a program answers to the start and to each sample of a case but the last."""
    rows = case.inputs.tolist()
    with link:
        answers = [link.start(rows[0])]
        for k, u in enumerate(rows[:-1]):
            if case.states is not None:
                link.set_state(case.states[k].tolist())
            answers.append(link.update(u))
    return answers


def compare(programs: Programs, case: Case, outputs: Sequence[str]) -> Comparison:
    """Runs a case on all three; `outputs` are the names of the outputs in their order.

    Raises:
        TargetError: a program was lost, hung or crashed.
    """
    target, single, double = (responses(start(), case) for start in programs[:3])
    there, here = (np.array([answer.outputs for answer in of]) for of in (target, double))
    distance = np.abs(there - here)
    T_ref, T_gear_hat = outputs.index("T_ref"), outputs.index("T_gear_hat")
    allowed = ABSOLUTE + RELATIVE * np.abs(here[:, T_ref])
    counts = [answer.count for answer in target[1:]]
    return Comparison(
        case=case,
        samples=len(there),
        differing=sum(a.bytes != b.bytes for a, b in zip(target, single, strict=True)),
        T_ref=float(distance[:, T_ref].max()),
        T_gear_hat=float(distance[:, T_gear_hat].max()),
        margin=float((distance[:, T_ref] / allowed).max()),
        largest=float(np.abs(here[:, T_ref]).max()),
        instructions=(float(np.mean(counts)), max(counts)),
        stack=max(answer.stack for answer in target[1:]),
        finite=bool(np.isfinite(there).all()),
        traces=(there[:, T_ref], here[:, T_ref]),
        states=np.array([answer.state for answer in target]),
    )


class InLoop(NamedTuple):
    """A manoeuvre with the controller on the target.

    Attributes:
        differing: samples in which T_ref is not, bit by bit, what the C makes of the same inputs off-line.
        T_ref, T_gear: in N.m, largest distance from the loop with the model in double precision.
        rms: of that of T_ref.
    """

    manoeuvre: str
    differing: int
    T_ref: float
    T_gear: float
    rms: float


def in_loop(programs: Programs, resolved: ResolvedLoop, names: Sequence[str]) -> Iterator[InLoop]:
    """Drives every manoeuvre; `names` are those of the controller's inputs.

    Raises:
        SimulationError: the target was lost, hung or crashed.
    """
    with TemporaryDirectory(prefix="driveline-") as temporary:
        path = build_on_target(CONTROLLERS[str(resolved.settings.controller)], Path(temporary))
        for manoeuvre in (for_car(each, resolved.T_max) for each in USUAL_MANOEUVRES):
            there = at_samples(simulate(manoeuvre, resolved, controller=path))
            here = at_samples(simulate(manoeuvre, resolved))
            off_line = responses(programs.single(), fed(manoeuvre, there, resolved.system, names))
            T_ref = np.array([answer.outputs[0] for answer in off_line])
            distance, twist = (np.abs(there[name] - here[name]) for name in (roles.REFERENCE_TORQUE, roles.GEAR_TORQUE))
            yield InLoop(
                manoeuvre.name,
                differing=int(np.count_nonzero(T_ref != there[roles.REFERENCE_TORQUE])),
                T_ref=float(np.max(distance)),
                T_gear=float(np.max(twist)),
                rms=float(np.sqrt(np.mean(distance**2))),
            )

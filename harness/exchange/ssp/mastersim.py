"""The project file of MasterSim, which opens FMUs but no SSP."""

from collections.abc import Mapping, Sequence

from fmuloop.wiring import Fit

from ...loop.places import STEP_SIZE
from .variables import Value, their_name

FOLDER = "extra/de.bauklimatik-dresden.mastersim"
"""In the archive, named as the standard wants it after the domain of the tool."""

COLOURS = ("#1b4f72", "#b03a2e", "#1e8449", "#9c640c", "#6c3483")


def project(fitted: Fit, values: Mapping[str, Sequence[Value]], stop_time: float) -> bytes:
    """The project: constant steps, all FMUs with the values of the beginning of a step.

    Args:
        values: parameters by instance.
        stop_time: in s.
    """
    settings = {
        "tStart": "0 s",
        "tEnd": f"{stop_time!r} s",
        "hMax": "30 min",
        "hMin": "1e-05 s",
        "hFallBackLimit": "0.001 s",
        "hStart": f"{STEP_SIZE!r} s",
        "hOutputMin": f"{STEP_SIZE!r} s",
        "adjustStepSize": "no",
        "preventOversteppingOfEndTime": "yes",
        "absTol": "1e-06",
        "relTol": "1e-05",
        "MasterMode": "GAUSS_JACOBI",
        "ErrorControlMode": "NONE",
        "maxIterations": "1",
        "writeInternalVariables": "no",
    }
    system = fitted.system
    fmus = {instance: interface.path.name for instance, interface in fitted.interfaces.items()}
    lines = [
        *(f"{name:24} {value}" for name, value in settings.items()),
        "",
        *(
            f'simulator {k} 0 {instance} {COLOURS[k % len(COLOURS)]} "../../resources/{file}"'
            for k, (instance, file) in enumerate(fmus.items())
        ),
        "",
        *(f"graph {_theirs(fitted, c.source)} {_theirs(fitted, c.target)}" for c in system.connections),
        "",
        *(
            f"parameter {instance}.{value.name} {str(value.value).lower()}"
            for instance, every in values.items()
            for value in every
        ),
    ]
    return ("\n".join(lines) + "\n").encode()


def _theirs(fitted: Fit, name: str) -> str:
    return f"{name.partition('.')[0]}.{their_name(fitted.system, name)}"

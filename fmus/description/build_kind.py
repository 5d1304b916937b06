"""What the two builds of a block say of themselves; everything else is the same in both."""

from dataclasses import dataclass
from importlib.metadata import version

from ..protocol import LOG_CATEGORIES, LOG_DISCARD


@dataclass(frozen=True)
class BuildKind:
    """One way to build FMUs.

    Attributes:
        tool: what made it.
        capabilities: attributes of the element CoSimulation that are not the same in every build.
        log_categories: names and descriptions.
        needs: what the host must have, as HTML.
        inputs: how inputs are taken over a communication step, as HTML.
        source_files: C files in the folder sources that together are the FMU.
    """

    tool: str
    capabilities: dict[str, str]
    log_categories: dict[str, str]
    needs: str
    inputs: str = "Inputs are held over a communication step."
    source_files: tuple[str, ...] = ()


def python_kind() -> BuildKind:
    """The build with PythonFMU."""
    return BuildKind(
        tool=f"PythonFMU {version('pythonfmu')}",
        capabilities={
            "canInterpolateInputs": "false",
            "maxOutputDerivativeOrder": "0",
            "canNotUseMemoryManagementFunctions": "true",
            "providesDirectionalDerivative": "false",
        },
        log_categories={LOG_DISCARD: LOG_CATEGORIES[LOG_DISCARD]},
        needs="""The model is Python code inside this file, on the
standard library alone. The host process must be a Python of version 3.11 or later, or have loaded
libpython with its symbols visible (on Linux: LD_PRELOAD).""",
    )

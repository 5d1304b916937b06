"""Building a native FMU: C source, its binaries, description and documentation in one archive."""

from collections.abc import Callable, Mapping
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path

from ...models.block.types import ContinuousBlock
from ..archive import guid_of, write_archive
from ..description.build_kind import BuildKind
from ..description.documentation import documentation
from ..description.model_description import model_description
from ..fmu import Fmu
from ..origin import origin_entry
from ..protocol import LOG_CATEGORIES
from .compiler import WHOLE, host_binaries
from .shared_header import shared_header
from .source import block_sources, variables_header
from .tableau import rosenbrock_header, step_header

C_FILES = Path(__file__).parent / "c"
FMI_HEADERS = Path(str(files("fmpy"))) / "c-code"

FOR_ALL = (
    "content.c",
    "fmi2.c",
    "fmi2_adapter.h",
    "messages.c",
    "run.c",
    "state.c",
    "values.c",
    "instance.h",
    "operators.h",
    "variable.h",
)
FOR_CONTINUOUS = (
    "fmi2_model_exchange.c",
    "model_exchange.c",
    "model_exchange.h",
    "continuous.c",
    "explicit.c",
    "implicit.c",
    "integrator.c",
    "explicit.h",
    "implicit.h",
    "integrator.h",
)
FOR_SAMPLED = ("sampled.c",)

NEEDS = """The model is compiled code in this file and needs nothing else; its C source is in the
folder <code>sources</code>."""

ALL = """/* {name}: the one file to compile.

With FMI2_FUNCTION_PREFIX defined as {name}_ it can be linked with other FMUs, without it makes a shared library. */
{included}"""

MOVING = """An input is held over a communication step, or moves at the rate that fmi2SetRealInputDerivatives
gave it for that step."""


EXCHANGE = {"canNotUseMemoryManagementFunctions": "false", "providesDirectionalDerivative": "true"}
"""What model exchange can do in a native build."""


def build_native(
    fmu: Fmu, folder: Path, binaries: Callable[[str, Mapping[str, bytes]], dict[str, bytes]] = host_binaries
) -> Path:
    """Builds `folder/<name>.fmu`, replacing one that is there, and returns its path.

    Args:
        binaries: compiles; `host_binaries` or `all_binaries` of .compiler.

    Raises:
        CompilerError: there is no compiler, or it refuses the source.
    """
    sources = c_sources(fmu)
    kind = native_kind(fmu)
    guid = guid_of(model_description(fmu, kind, ""), sources)
    sources["variables.h"] = variables_header(fmu, guid).encode()
    packed = {f"sources/{name}": content for name, content in sources.items()}
    packed |= binaries(fmu.name, sources) | documentation(fmu, kind) | origin_entry(fmu)
    packed["modelDescription.xml"] = model_description(fmu, kind, guid)
    target = folder / f"{fmu.name}.fmu"
    write_archive(packed, target)
    return target


def c_sources(fmu: Fmu) -> dict[str, bytes]:
    """All C files of an FMU by name, with an empty GUID."""
    names = FOR_ALL + (FOR_CONTINUOUS if isinstance(fmu.block, ContinuousBlock) else FOR_SAMPLED)
    sources = {name: (C_FILES / name).read_bytes() for name in names}
    sources |= {header.name: header.read_bytes() for header in FMI_HEADERS.glob("fmi2*.h")}
    generated = block_sources(fmu) | {"variables.h": variables_header(fmu, ""), "shared.h": shared_header()}
    if isinstance(fmu.block, ContinuousBlock):
        generated |= {"dop853.h": step_header(), "rodas.h": rosenbrock_header()}
    sources |= {name: text.encode() for name, text in generated.items()}
    included = "".join(f'#include "{name}"\n' for name in sorted(sources) if name.endswith(".c"))
    return sources | {WHOLE: ALL.format(name=fmu.name, included=included).encode()}


def native_kind(fmu: Fmu) -> BuildKind:
    """What the native build of an FMU says of itself; rates of change are known of continuous blocks."""
    continuous = isinstance(fmu.block, ContinuousBlock)
    return BuildKind(
        tool=f"CasADi {version('casadi')}",
        capabilities={
            "canInterpolateInputs": "true" if continuous else "false",
            "maxOutputDerivativeOrder": "1" if continuous else "0",
            "canNotUseMemoryManagementFunctions": "false",
            "providesDirectionalDerivative": "true" if continuous else "false",
        },
        model_exchange=EXCHANGE if continuous else {},
        log_categories=LOG_CATEGORIES,
        needs=NEEDS,
        source_files=(WHOLE,),
        **({"inputs": MOVING} if continuous else {}),
    )

"""Building a native FMU: C source, its binaries, description and documentation in one archive."""

from collections.abc import Callable, Mapping
from pathlib import Path

from ..archive import guid_of, write_archive
from ..block.types import ContinuousBlock
from ..description.build_kind import BuildKind
from ..description.documentation import documentation
from ..description.model_description import model_description
from ..description.model_description_3 import build_description, model_description_3
from ..description.terminal import terminal_files
from ..fmu import Fmu
from ..origin import origin_entry
from ..protocol import LOG_CATEGORIES
from .compiler import WHOLE, host_binaries
from .shared_header import shared_header
from .source import block_sources, frame_header, variables_header
from .tableau import rosenbrock_header, step_header
from .trace import trace_frame
from .xcp import xcp_entries

C_FILES = Path(__file__).parent / "c"
FMI_HEADERS = Path(__file__).parent / "fmi"
"""Those of the standard, as the Modelica Association publishes them."""

ADAPTERS = {2: ("fmi2.c", "fmi2_adapter.h"), 3: ("fmi3.c", "fmi3_instance.c", "fmi3_refused.c")}
"""Of the core to each FMI."""

DESCRIPTIONS = {2: model_description, 3: model_description_3}
"""What writes the model description of each FMI."""

FOR_ALL = (
    *("calls.c", "content.c", "first_instance.c", "messages.c", "run.c", "state.c", "values.c", "instance.h"),
    *("operators.h", "variable.h"),
)
FOR_CONTINUOUS = (
    *("continuous.c", "explicit.c", "implicit.c", "integrator.c", "explicit.h", "implicit.h", "integrator.h"),
    *("model_exchange.c", "model_exchange.h"),
)
FOR_SAMPLED = ("sampled.c",)
FOR_TERMINAL = ("fmi3_terminal.c", "frames.c", "terminal.c", "terminal.h")

NEEDS = """The model is compiled code in this file and needs nothing else; its C source is in the
folder <code>sources</code>."""

ALL = """/* {name}: the one file to compile.

With FMI{fmi}_FUNCTION_PREFIX defined as {name}_ it can be linked with other FMUs, without it makes a shared library. */
{included}"""

WITH_TERMINAL = "#define TERMINAL /* it sends its frames over a bus */\n"
"""Goes before what is included."""

MOVING = {
    2: """An input is held over a communication step, or moves at the rate that fmi2SetRealInputDerivatives
gave it for that step.""",
    3: """An input moves over a communication step at the rate that is set for it (der(...)), which is 0
until it is set.""",
}
"""How the inputs of continuous blocks are taken in each FMI."""

FRAMES = """Inputs are held over a communication step. In event mode the terminal <code>Powertrain</code> sends what has
arrived in the step as frames (FMI-LS-BUS); their database is in the folder <code>extra</code>."""
"""How inputs are taken, and frames sent, by an FMU with a terminal."""

EXCHANGE = {
    2: {"canNotUseMemoryManagementFunctions": "false", "providesDirectionalDerivative": "true"},
    3: {"providesDirectionalDerivatives": "true"},
}
"""What model exchange can do in a native build of each FMI."""


def build_native(
    fmu: Fmu,
    folder: Path,
    binaries: Callable[[str, Mapping[str, bytes], int], dict[str, bytes]] = host_binaries,
    fmi: int = 2,
    database: bytes = b"",
) -> Path:
    """Builds `folder/<name>.fmu`, replacing one that is there, and returns its path. Threads compile side by side.

    Args:
        binaries: compiles; `host_binaries` or `all_binaries` of .compiler.
        fmi: 2 for FMI 2.0, 3 for FMI 3.0.
        database: DBC of the bus over which the FMU, of FMI 3.0 and with a sampled block, sends its first frame; none:
            it sends none.

    Raises:
        CompilerError: there is no compiler, or it refuses the source.
    """
    sends = bool(database)
    kind, describe = native_kind(fmu, fmi, sends), DESCRIPTIONS[fmi]
    sources, guid = native_sources(fmu, fmi, sends)
    packed = {f"sources/{name}": content for name, content in sources.items()}
    compiled = binaries(fmu.name, sources, fmi)
    packed |= (
        compiled
        | documentation(fmu, kind)
        | xcp_entries(fmu, sources["block.h"].decode(), compiled)
        | origin_entry(fmu, "native")
    )
    packed["modelDescription.xml"] = describe(fmu, kind, guid)
    if fmi == 3:
        packed["sources/buildDescription.xml"] = build_description(fmu, kind)
    if sends:
        packed |= terminal_files(fmu.block, database)
    target = folder / f"{fmu.name}.fmu"
    write_archive(packed, target)
    return target


def native_sources(fmu: Fmu, fmi: int = 2, sends: bool = False) -> tuple[dict[str, bytes], str]:
    """All C files of an FMU by name, and its GUID, which comes from its content."""
    sources = c_sources(fmu, fmi, sends)
    guid = guid_of(DESCRIPTIONS[fmi](fmu, native_kind(fmu, fmi, sends), ""), sources)
    return sources | {"variables.h": variables_header(fmu, guid, fmi).encode()}, guid


def c_sources(fmu: Fmu, fmi: int = 2, sends: bool = False) -> dict[str, bytes]:
    """All C files of an FMU by name, with an empty GUID."""
    continuous = isinstance(fmu.block, ContinuousBlock)
    names = (
        ADAPTERS[fmi]
        + FOR_ALL
        + (FOR_TERMINAL if sends else ())
        + ((*FOR_CONTINUOUS, f"fmi{fmi}_model_exchange.c") if continuous else FOR_SAMPLED)
    )
    sources = {name: (C_FILES / name).read_bytes() for name in names}
    sources |= {header.name: header.read_bytes() for header in FMI_HEADERS.glob(f"fmi{fmi}*.h")}
    generated = block_sources(fmu, others=(trace_frame(fmu.block),) if sends else ()) | {
        "variables.h": variables_header(fmu, "", fmi),
        "shared.h": shared_header(),
    }
    if isinstance(fmu.block, ContinuousBlock):
        generated |= {"dop853.h": step_header(), "rodas.h": rosenbrock_header()}
    if sends:
        generated["frame.h"] = frame_header(fmu)
    sources |= {name: text.encode() for name, text in generated.items()}
    included = WITH_TERMINAL if sends else ""
    included += "".join(f'#include "{name}"\n' for name in sorted(sources) if name.endswith(".c"))
    return sources | {WHOLE: ALL.format(name=fmu.name, fmi=fmi, included=included).encode()}


def native_kind(fmu: Fmu, fmi: int = 2, sends: bool = False) -> BuildKind:
    """What the native build of an FMU says of itself; rates of change are known of continuous blocks."""
    continuous = isinstance(fmu.block, ContinuousBlock)
    differentiable = "true" if continuous else "false"
    of_version = {
        2: {
            "canInterpolateInputs": differentiable,
            "canNotUseMemoryManagementFunctions": "false",
            "providesDirectionalDerivative": differentiable,
        },
        3: {"providesDirectionalDerivatives": differentiable},
    }
    return BuildKind(
        capabilities={"maxOutputDerivativeOrder": "1" if continuous else "0"}
        | of_version[fmi]
        | ({"hasEventMode": "true"} if sends else {}),
        model_exchange=EXCHANGE[fmi] if continuous else {},
        log_categories=LOG_CATEGORIES,
        needs=NEEDS,
        source_files=(WHOLE,),
        version=f"{fmi}.0",
        picture={2: "model.png", 3: "documentation/diagram.png"}[fmi],
        has_terminal=sends,
        **({"inputs": MOVING[fmi]} if continuous else {"inputs": FRAMES} if sends else {}),
    )

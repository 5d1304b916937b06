"""WebAssembly modules that need nothing else, of the C of FMUs, by the compiler of Zig."""

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

from toolground.atomic_files import complete

from ..fmu import Fmu
from ..native.compiler import FLAGS, WHOLE, compile_in, run_compiler, zig_compiler
from ..native.packaging import FMI_HEADERS, native_sources

TARGET = ("-target", "wasm32-wasi")
FAST = ("-msimd128", "-flto")
"""Two numbers at a time, each with its own rounding, as every browser of the last years can; and functions of FMUs
within what calls them."""

LINKED = ("-mexec-model=reactor", "-s", "-Wl,-z,stack-size=262144")
"""Nothing is imported: what would print is not linked."""

INSTANCE = Path(__file__).with_name("instance.c")

CALLBACKS = Path(__file__).with_name("callbacks.h")


def build_wasm(fmu: Fmu, folder: Path) -> Path:
    """Makes `folder/<name>.wasm` of an FMU of FMI 2.0, and returns its path.

    Its host allocates with the exported `malloc` what the functions of FMI 2.0 are to read and write.

    Raises:
        CompilerError: there is no Zig, or it refuses the source.
    """
    sources = {fmu.name: native_sources(fmu)[0]}
    exports = ("instantiate", "last_message", "malloc", "free")
    code = linked(sources, {INSTANCE.name: INSTANCE.read_bytes()}, exports, exported_fmi=True)
    target = folder / f"{fmu.name}.wasm"
    with complete(target) as unfinished:
        unfinished.write_bytes(code)
    return target


def linked(
    fmus: Mapping[str, Mapping[str, bytes]],
    own: Mapping[str, bytes],
    exports: Sequence[str],
    defined: Sequence[str] = (),
    exported_fmi: bool = False,
) -> bytes:
    """The module of FMUs of FMI 2.0 and what calls them.

    Args:
        fmus: their C files by name, by the names of the FMUs, which their functions have for a prefix.
        own: C files that call them; the first is compiled, it may include the others and `callbacks.h`.
        exports: functions that the host of the module gets.
        defined: options that define macros of the C file.
        exported_fmi: whether the functions of the one FMU have no prefix, and the host gets them too.

    Raises:
        CompilerError: there is no Zig, or it refuses a source.
    """
    zig = [*zig_compiler(), *TARGET]
    files = {
        **own,
        CALLBACKS.name: CALLBACKS.read_bytes(),
        **{header.name: header.read_bytes() for header in FMI_HEADERS.glob("fmi2*.h")},
    }
    exported = (*(f"-Wl,--export={name}" for name in exports), *(["-Wl,--export-dynamic"] if exported_fmi else []))
    with TemporaryDirectory() as temporary, ThreadPoolExecutor() as pool:

        def compiled(name: str) -> bytes:
            prefix = [] if exported_fmi else [f"-DFMI2_FUNCTION_PREFIX={name}_"]
            command = [*zig, *FLAGS, *FAST, *prefix, "-c", WHOLE, "-o", f"{name}.o"]
            return compile_in(command, f"{name}.o", fmus[name])

        folder = Path(temporary)
        for name, code in zip(fmus, pool.map(compiled, fmus), strict=True):
            (folder / f"{name}.o").write_bytes(code)
        for name, content in files.items():
            (folder / name).write_bytes(content)
        objects = [f"{name}.o" for name in fmus]
        command = [*zig, *FLAGS, *FAST, *defined, next(iter(own)), *objects, *LINKED, *exported, "-o", "module.wasm"]
        run_compiler(command, folder)
        return (folder / "module.wasm").read_bytes()

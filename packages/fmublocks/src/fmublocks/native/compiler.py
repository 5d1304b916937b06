"""Compiling the C of an FMU: for this machine with its own compiler or that of Zig, for all platforms with that one."""

import os
import shutil
import struct
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from errno import ENOSPC
from importlib.util import find_spec
from pathlib import Path
from platform import machine

from toolground.child_process import run
from toolground.errors import full_disk

from ..errors import BuildError

FLAGS = (
    # the header of FMI 3.0 declares callbacks without prototypes
    *("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-Wno-strict-prototypes"),
    # each operation rounds on its own, as in Python
    *("-ffp-contract=off", "-O2", "-fno-unroll-loops", "-g0", "-fvisibility=hidden"),
)

LIBRARY_FLAGS = (
    *("-shared", "-fPIC", "-s", "-DOLD_GLIBC"),
    # nothing looks at errno, nothing is thrown
    *("-fno-math-errno", "-fno-asynchronous-unwind-tables", "-fno-unwind-tables"),
)

WINDOWS_LIBRARIES = tuple(
    f"-lapi-ms-win-crt-{part}-l1-1-0" for part in ("math", "stdio", "string", "convert", "heap", "private")
)
"""The C library that is part of Windows."""

WHOLE = "all.c"
"""The file of an FMU's source that is compiled; it includes the others."""

WINDOWS_SOURCE = Path(__file__).parent / "windows.c"

LINUX, WINDOWS, MAC_INTEL, MAC_ARM = (
    "x86_64-linux-gnu.2.17",
    "x86_64-windows-gnu",
    "x86_64-macos.11.0",
    "aarch64-macos.11.0",
)
"""Targets as Zig names them."""

MAC_PROCESSORS = {MAC_INTEL: (0x01000007, 3), MAC_ARM: (0x0100000C, 0)}
"""Type and subtype of the processor in a Mach-O file."""

WHERE_HEADER = 0x3C
"""Where a library for Windows tells where its header is."""

UNIVERSAL_MAGIC, PAGE_BITS = 0xCAFEBABE, 14


LIBRARY_ENDINGS = {"win32": ".dll", "darwin": ".dylib"}

SYSTEMS = {"win32": ("win", "windows"), "darwin": ("darwin", "darwin")}
"""As FMI 2.0 and FMI 3.0 name them; all others are Linux."""


class CompilerError(BuildError):
    """There is no compiler, or it refuses the source; the text says why."""


def host_platform(fmi: int = 2) -> str:
    """The folder of an FMU of that FMI which has the binary for this machine."""
    system, long_system = SYSTEMS.get(sys.platform, ("linux", "linux"))
    bits = 64 if sys.maxsize > 2**32 else 32
    if fmi == 2:
        return f"{system}{bits}"
    processor = "aarch64" if machine().lower() in ("aarch64", "arm64") else "x86_64" if bits == 64 else "x86"
    return f"{processor}-{long_system}"


def host_binaries(name: str, sources: Mapping[str, bytes], fmi: int = 2) -> dict[str, bytes]:
    """The binary for this machine, by its path in the FMU of that FMI.

    Raises:
        CompilerError: see there.
    """
    folder, binary = host_platform(fmi), name + LIBRARY_ENDINGS.get(sys.platform, ".so")
    if sys.platform == "win32":
        return {f"binaries/{folder}/{binary}": _compiled_for_windows(zig_compiler(), binary, sources)}
    return {f"binaries/{folder}/{binary}": _compiled(host_command(), binary, sources)}


def host_command() -> list[str]:
    """The command of the C compiler for FMUs of this machine: its own, or where there is none and on Windows Zig's.

    Raises:
        CompilerError: there is neither.
    """
    if sys.platform == "win32":
        return zig_compiler()
    try:
        return [host_compiler()]
    except CompilerError:
        if "CC" in os.environ or find_spec("ziglang") is None:
            raise
        return zig_compiler()


def all_binaries(name: str, sources: Mapping[str, bytes], fmi: int = 2) -> dict[str, bytes]:
    """The binaries for Linux, Windows and macOS, by their paths in the FMU of that FMI.

    Raises:
        CompilerError: see there.
    """
    zig = zig_compiler()
    linux = _compiled([*zig, "-target", LINUX], f"{name}.so", sources)
    windows = _compiled_for_windows(zig, f"{name}.dll", sources)
    on_mac = {target: _compiled([*zig, "-target", target], f"{name}.dylib", sources) for target in MAC_PROCESSORS}
    # the name of FMI 3, which some tools look for in an FMU of FMI 2.0 as well
    common = {f"binaries/aarch64-darwin/{name}.dylib": on_mac[MAC_ARM]}
    if fmi == 3:
        return common | {
            f"binaries/x86_64-linux/{name}.so": linux,
            f"binaries/x86_64-windows/{name}.dll": windows,
            f"binaries/x86_64-darwin/{name}.dylib": on_mac[MAC_INTEL],
        }
    return common | {
        f"binaries/linux64/{name}.so": linux,
        f"binaries/win64/{name}.dll": windows,
        f"binaries/darwin64/{name}.dylib": universal(on_mac),
    }


def host_compiler() -> str:
    """The C compiler of this machine.

    Raises:
        CompilerError: there is none.
    """
    name = os.environ.get("CC", "cc")
    if shutil.which(name) is None:
        raise CompilerError(
            f"there is no C compiler {name!r} "
            "(the environment variable CC can name another, `pip install ziglang` has one)"
        )
    return name


def zig_compiler() -> list[str]:
    """The command of Zig's C compiler.

    Raises:
        CompilerError: it is not installed.
    """
    if find_spec("ziglang") is None:
        raise CompilerError("to compile for all platforms, and on Windows, install Zig: pip install 'fmublocks[cross]'")
    return [sys.executable, "-m", "ziglang", "cc"]


def _compiled(compiler: Sequence[str], binary: str, sources: Mapping[str, bytes]) -> bytes:
    return compile_in([*compiler, *FLAGS, *LIBRARY_FLAGS, WHOLE, "-o", binary, "-lm"], binary, sources)


def compile_in(command: Sequence[str], binary: str, sources: Mapping[str, bytes]) -> bytes:
    """What a command makes of sources.

    Raises:
        CompilerError: it complains, or makes nothing.
    """
    with _folder_of(sources) as folder:
        run_compiler(command, folder)
        if not (output := folder / binary).is_file():
            raise CompilerError(f"{' '.join(command)}\nit ended well and made no {binary}")
        return output.read_bytes()


def _compiled_for_windows(zig: Sequence[str], binary: str, sources: Mapping[str, bytes]) -> bytes:
    """Linked without Zig's runtime, which would be larger than the FMU."""
    with _folder_of({**sources, WINDOWS_SOURCE.name: WINDOWS_SOURCE.read_bytes()}) as folder:
        compiler = [*zig, "-target", WINDOWS]
        objects: list[str] = []
        for file in (WHOLE, WINDOWS_SOURCE.name):
            objects.append(file.replace(".c", ".o"))
            run_compiler([*compiler, *FLAGS, "-c", file, "-o", objects[-1]], folder)
        run_compiler([*compiler, "-nostdlib", "-shared", "-s", *objects, *WINDOWS_LIBRARIES, "-o", binary], folder)
        return _undated((folder / binary).read_bytes())


def _undated(dll: bytes) -> bytes:
    """The library without the time at which it was linked, so that a rebuild gives the same bytes."""
    (header,) = struct.unpack_from("<I", dll, WHERE_HEADER)
    return dll[: header + 8] + bytes(4) + dll[header + 12 :]


@contextmanager
def _folder_of(sources: Mapping[str, bytes]) -> Iterator[Path]:
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for name, content in sources.items():
            (folder / name).write_bytes(content)
        yield folder


def run_compiler(command: Sequence[str], folder: Path) -> None:
    """Runs a compiler in a folder.

    Raises:
        CompilerError: it complains; the text is what it says.
        OSError: the disk of temporary files is full.
    """
    done = run(command, folder)
    if done.returncode and os.strerror(ENOSPC) in done.stderr:
        raise full_disk()
    if done.returncode:
        raise CompilerError(f"{' '.join(command)}\n{done.stdout}{done.stderr}")


def universal(binaries: Mapping[str, bytes]) -> bytes:
    """One Mach-O file for several processors: a table of where each one's part lies, and the parts.

    Args:
        binaries: keys are those of MAC_PROCESSORS.
    """
    page = 1 << PAGE_BITS
    header, parts = struct.pack(">II", UNIVERSAL_MAGIC, len(binaries)), b""
    for target, content in binaries.items():
        offset = page + len(parts)
        header += struct.pack(">IIIII", *MAC_PROCESSORS[target], offset, len(content), PAGE_BITS)
        parts += content + b"\0" * (-len(content) % page)
    return header.ljust(page, b"\0") + parts

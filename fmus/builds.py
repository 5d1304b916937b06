"""Which builds of an FMU are possible on this machine."""

from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path

from .fmu import Fmu
from .python.packaging import build

BUILDS = ("python", "native", "both")
PLATFORMS = ("host", "all")

NATIVE_FOLDER = "native"
"""Folder of the native builds, in that of the others."""

Builder = Callable[[Fmu, Path], Path]
"""Builds an FMU into a folder and returns the path of its file."""


class NotPossible(Exception):
    """Something that a build needs is missing; the text says what."""


def builders(builds: str | None, platform: str = "host") -> list[Builder]:
    """What makes the chosen builds.

    Args:
        builds: one of BUILDS; None for each that is possible.
        platform: of the native build, one of PLATFORMS.

    Raises:
        NotPossible: a build that is asked for cannot be made here.
    """
    if builds == "python":
        return [build]
    try:
        native = _native_builder(platform)
    except NotPossible:
        if builds is None and platform == "host":
            return [build]
        raise
    return [native] if builds == "native" else [build, native]


def _native_builder(platform: str) -> Builder:
    if find_spec("casadi") is None:
        raise NotPossible("the native build needs CasADi: install the extra `native` (pip install '.[native]')")
    from .native import compiler
    from .native.packaging import build_native

    try:
        if platform == "all":
            compiler.zig_compiler()
        else:
            compiler.host_compiler()
    except compiler.CompilerError as reason:
        raise NotPossible(str(reason)) from reason
    binaries = compiler.all_binaries if platform == "all" else compiler.host_binaries
    return partial(_into_own_folder, partial(build_native, binaries=binaries))


def _into_own_folder(builder: Builder, fmu: Fmu, folder: Path) -> Path:
    return builder(fmu, folder / NATIVE_FOLDER)

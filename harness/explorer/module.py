"""The module of a page: FMUs of which there is C source, and loops of them, as WebAssembly that needs nothing else."""

import gzip
import hashlib
import json
import zipfile
from base64 import b64encode
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from fmublocks.native.compiler import WHOLE, CompilerError, zig_compiler
from fmublocks.native.packaging import build_native
from fmublocks.wasm import linked
from fmuloop.compiled_steps import SOURCE as STEPS
from fmuloop.interface import Interface, type_of, unit_of
from fmuloop.wiring import Fit
from toolground.atomic_files import complete
from toolground.collected_warnings import warn_once
from toolground.errors import UserError
from toolground.user_cache import is_as_made, kept, named_as_cache, user_cache

from ...fmus.catalogue import EVERY
from ...fmus.origin import sources_digest
from ..loop.places import NATIVE, PLACES
from ..loop.resolved import ResolvedLoop, resolve
from ..metrics.evaluate import COLUMNS
from .tables import ROWS, Loop, loop, tables

HERE = Path(__file__).parent
C_FILES = [HERE / "c" / name for name in ("page_loop.c", "page_mode.c")]
EXPORTS = (
    *("begin", "set", "start_run", "run_steps", "rows", "last_message"),
    *("begin_mode", "set_of_mode", "mode_frequency"),
)
SOURCES = "sources/"
"""Of an FMU, in its archive."""

PACKAGED = HERE / "page" / "loops.json"
"""Of all loops of the project, made when the package is."""


class Module(NamedTuple):
    """A module, and what a page has to know of it.

    Attributes:
        code: WebAssembly.
        content: names, GUIDs, digests and parameters of the FMUs; places, columns and numbers of the loops.
    """

    code: bytes
    content: dict[str, Any]

    def packed(self) -> str:
        """JSON: the content, and the code compressed and in base64."""
        code = b64encode(gzip.compress(self.code, 9, mtime=0)).decode()
        return json.dumps({**self.content, "code": code}, separators=(",", ":"))


def named(plant: str, controller: str) -> str:
    """What a loop is called in a module."""
    return f"{plant} {controller}"


def loops_of(fits: Mapping[str, Fit], are_ours: bool) -> dict[str, Any]:
    """What `packed` gives of loops, by their names; those of blocks of the project alone are in the standard module.

    Raises:
        UserError: there is no Zig and no module, or an FMU has no C source of FMI 2.0.
    """
    if are_ours:
        return standard()
    paths = dict.fromkeys(each.path for fitted in fits.values() for each in fitted.interfaces.values())
    return _kept(digest_of([repr(list(fits)).encode(), *(path.read_bytes() for path in paths)]), lambda: build(fits))


def standard() -> dict[str, Any]:
    """What `packed` gives of all loops of the project: made with the package, else by Zig and then kept.

    Raises:
        UserError: it is not there, and there is no Zig.
    """
    return _packaged() or _kept(_standard_digest(), _standard)


def require_possible() -> None:
    """Looks whether there are the loops of the project, or Zig, before anything is built.

    Raises:
        UserError: neither is there.
    """
    if not (_packaged() or is_as_made(_place(_standard_digest()))):
        _zig()


def _packaged() -> dict[str, Any] | None:
    """The loops that were made with the package, if they are those of the sources that are here."""
    found = json.loads(PACKAGED.read_text(encoding="utf-8")) if PACKAGED.is_file() else {}
    return found if found.get("made_of") == _standard_digest() else None


def _place(made_of: str) -> Path:
    """Of a module in the cache."""
    return user_cache() / "pages" / made_of[:32] / PACKAGED.name


def write_standard(path: Path = PACKAGED) -> None:
    """Makes the module of all loops of the project, for a package.

    Raises:
        UserError: there is no Zig.
    """
    made = _standard()
    made.content["made_of"] = _standard_digest()
    with complete(path) as unfinished:
        unfinished.write_text(made.packed(), encoding="utf-8")


def _standard_digest() -> str:
    return digest_of([sources_digest().encode()])


def _kept(made_of: str, make: Callable[[], Module]) -> dict[str, Any]:
    """A module of the cache, which is made where it is not there."""

    def write(path: Path) -> None:
        warn_once("compiling the loops of the page, once for these FMUs: takes half a minute")
        made = make()
        made.content["made_of"] = made_of
        path.write_text(made.packed(), encoding="utf-8")

    path = _place(made_of)
    with named_as_cache(path.parents[1]):
        return json.loads(kept(path, write).read_text(encoding="utf-8"))


def _standard() -> Module:
    with built_as_sources() as loops:
        return build({named(*key): resolved.fit for key, resolved in loops.items()})


@contextmanager
def built_as_sources() -> Iterator[dict[tuple[str, str], ResolvedLoop]]:
    """The loops of all blocks of the project by the names of plant and controller, of FMUs without a binary, which are
    there within it."""
    with TemporaryDirectory() as folder, ThreadPoolExecutor() as pool:
        without_binary = partial(build_native, folder=Path(folder) / NATIVE, binaries=lambda *_: {})
        list(pool.map(without_binary, (EVERY[name] for names in PLACES.values() for name in names)))
        yield {
            (plant, controller): resolve(plant, controller=controller, folder=Path(folder), build=NATIVE)
            for plant in PLACES["plant"]
            for controller in PLACES["controller"]
        }


def digest_of(sources: Iterable[bytes]) -> str:
    """Of what a module is made of, beside the code that makes it."""
    own = [file.read_bytes() for file in (*C_FILES, STEPS, Path(__file__), HERE / "tables.py")]
    return hashlib.sha256(b"".join(hashlib.sha256(each).digest() for each in (*own, *sources))).hexdigest()


def build(fits: Mapping[str, Fit], columns: Sequence[str] = COLUMNS) -> Module:
    """Makes the module of loops, by their names.

    Args:
        columns: of the results that the page reads.

    Raises:
        CompilerError: Zig refuses a source.
        UserError: there is no Zig, or an FMU has no C source of FMI 2.0.
    """
    fmus = {each.identifier: each for fitted in fits.values() for each in fitted.interfaces.values()}
    sources = {name: sources_of(interface) for name, interface in fmus.items()}
    names = list(fmus)
    loops = [loop(k, fitted, _inputs(fitted), names) for k, fitted in enumerate(fits.values())]
    exchanging = frozenset(name for name, each in fmus.items() if each.description.modelExchange)
    guids = {name: str(interface.description.guid) for name, interface in fmus.items()}
    code = _linked(sources, tables(loops, guids, exchanging), loops)
    return Module(
        code,
        {
            "rows": ROWS,
            "fmus": {name: _fmu(interface, sources[name]) for name, interface in fmus.items()},
            "loops": {
                name: _loop(fitted, made, columns) for (name, fitted), made in zip(fits.items(), loops, strict=True)
            },
        },
    )


def sources_of(interface: Interface) -> dict[str, bytes]:
    """The C files of an FMU by name.

    Raises:
        UserError: it has none of FMI 2.0.
    """
    with zipfile.ZipFile(interface.path) as archive:
        found = {
            name.removeprefix(SOURCES): archive.read(name) for name in archive.namelist() if name.startswith(SOURCES)
        }
    if WHOLE not in found or interface.fmi != 2:
        raise UserError(
            f"{interface.path}: a page has loops of FMUs that were built from Python by `driveline build`, "
            "whose C source is in them (build/native has those); "
            "`driveline compare --report` and `simulate` run every FMU"
        )
    return found


def _inputs(fitted: Fit) -> list[str]:
    return [port.name for port in fitted.system.inputs if port.name not in fitted.absent]


def _zig() -> None:
    try:
        zig_compiler()
    except CompilerError as reason:
        raise UserError(
            "there is no Zig that makes the loops of a page: pip install ziglang; or install driveline-damping from a "
            "wheel"
        ) from reason


def _linked(sources: Mapping[str, Mapping[str, bytes]], head: str, loops: Sequence[Loop]) -> bytes:
    _zig()
    most = max(each.layout.dtype.itemsize for each in loops)
    defined = (f"-DROWS={ROWS}", f"-DMOST_BYTES={-(-most // 8) * 8}", "-DMOST_ROUNDS=16")
    own = {file.name: file.read_bytes() for file in (*C_FILES, STEPS)} | {"tables.h": head.encode()}
    return linked(sources, own, EXPORTS, defined)


KINDS = {"Real": 0, "Integer": 1, "Boolean": 2}
"""As the module numbers them."""


def _fmu(interface: Interface, sources: Mapping[str, bytes]) -> dict[str, Any]:
    digest = hashlib.sha256(b"".join(name.encode() + b"\0" + sources[name] for name in sorted(sources)))
    return {
        "guid": interface.description.guid,
        "sources": digest.hexdigest(),
        **({"torque": interface.variables["T_mot"].valueReference} if "T_mot" in interface.variables else {}),
        "parameters": {
            v.name: {
                "kind": KINDS[type_of(v)],
                "reference": v.valueReference,
                "start": number(v.start),
                "min": number(v.min),
                "max": number(v.max),
                "unit": unit_of(v) or "",
                "tunable": v.variability == "tunable",
            }
            for v in interface.of_causality("parameter")
            if type_of(v) in KINDS
        },
    }


def number(value: Any) -> float | None:
    """A start value or bound of a description; None if there is none."""
    if value is None:
        return None
    return float(value == "true") if value in ("true", "false") else float(value)


def _loop(fitted: Fit, made: Loop, columns: Sequence[str]) -> dict[str, Any]:
    layout = made.layout

    def is_real(name: str) -> bool:
        instance, _, own = name.partition(".")
        return type_of(fitted.interfaces[instance].variables[own]) == "Real"

    return {
        "instances": {name: each.identifier for name, each in fitted.interfaces.items()},
        "size": layout.dtype.itemsize,
        "inputs": {name: [layout.offset(name), int(is_real(name))] for name in made.inputs},
        "columns": {name: layout.offset(name) for name in columns if name in (layout.dtype.names or ())},
    }

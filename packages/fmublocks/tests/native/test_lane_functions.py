"""Sine and the like of several numbers at a time are those of single numbers."""

import platform
from ctypes import CDLL, c_size_t, c_void_p
from pathlib import Path

import numpy as np
import pytest
from fmutesting.together import together

from fmublocks.native.compiler import compile_in, host_compiler
from fmublocks.native.lanes import COMMON, FLAGS
from fmublocks.native.packaging import C_FILES
from toolground.lanes_here import FEATURES, lanes_here

pytestmark = pytest.mark.skipif(not lanes_here(), reason="this processor has no lanes")

FUNCTIONS = ("sin", "cos", "atan", "tanh", "exp", "log")

SOURCE = """#include "lanes.h"
#define OF(name) \\
    __attribute__((visibility("default"))) void name##s(const lanes x[], lanes y[], size_t count) \\
    { for (size_t k = 0; k < count; k++) y[k] = name##_in_lanes(x[k]); }
""" + "".join(f"OF({name})\n" for name in FUNCTIONS)

MODULO = """__attribute__((visibility("default")))
void moduli(const lanes x[], const lanes y[], lanes rest[], size_t count)
{ for (size_t k = 0; k < count; k++) rest[k] = modulo_in_lanes(x[k], y[k]); }
"""

BLOCK = "typedef double real;\n#include <stddef.h>\n"

COUNT = 4096


def library(folder, lanes):
    """That of the functions for so many lanes."""
    sources = {name: (C_FILES / name).read_bytes() for name in ("lanes.h", "operators.h")}
    sources |= {"block.h": BLOCK.encode(), "functions.c": (SOURCE + MODULO).encode()}
    path = folder / f"functions-{lanes}.so"
    command = [host_compiler(), *COMMON, *FLAGS[lanes], "-Wall", "-Werror", f"-DWIDTH={lanes}", "-shared", "-fPIC"]
    path.write_bytes(compile_in([*command, "functions.c", "-o", path.name, "-lm"], path.name, sources))
    return path


@pytest.fixture(scope="module", params=[lanes for lanes in FEATURES if lanes <= lanes_here()])
def functions(request, tmp_path_factory):
    """The functions for numbers in arrays."""
    loaded = CDLL(str(library(tmp_path_factory.mktemp("functions"), request.param)))

    def called(name, *arguments):
        aligned = np.zeros((len(arguments) + 1, COUNT + 8))
        first = -aligned.ctypes.data % 64 // 8
        rows = np.lib.stride_tricks.as_strided(aligned.ravel()[first:], (len(arguments) + 1, COUNT), (COUNT * 8, 8))
        for row, values in zip(rows, arguments, strict=False):
            row[:] = np.resize(values, COUNT)
        loaded[name](*(c_void_p(row.ctypes.data) for row in rows), c_size_t(COUNT // request.param))
        return rows[-1][: len(arguments[0])]

    return called


def spread(rng, least, most):
    """Numbers of all sizes between these, of both signs."""
    return np.exp(rng.uniform(np.log(least), np.log(most), COUNT - 8)) * rng.choice([-1.0, 1.0], COUNT - 8)


SPECIAL = [0.0, -0.0, np.nan, np.inf, -np.inf, 1e300, -1e300, 1e-310]


@together("name", FUNCTIONS)
def test_they_are_as_exact_as_those_of_the_c_library(functions, name):
    rng = np.random.default_rng(1)
    x = spread(rng, 1e-9, {"exp": 709.0, "sin": 1e12, "cos": 1e12}.get(name, 1e30))
    x = np.append(np.abs(x) if name == "log" else x, SPECIAL)
    with np.errstate(all="ignore"):
        right = getattr(np, {"atan": "arctan"}.get(name, name))(x)
    results = functions(f"{name}s", x)
    assert np.array_equal(np.isfinite(results), np.isfinite(right))
    assert np.array_equal(np.isnan(results), np.isnan(right))
    finite = np.isfinite(right)
    size = np.abs(right[finite]) if name in ("exp", "log", "atan") else np.ones(finite.sum())
    assert (np.abs(results[finite] - right[finite]) <= 4e-16 * size).all()
    assert np.array_equal(results[~finite & ~np.isnan(right)], right[~finite & ~np.isnan(right)])


def test_the_remainder_is_that_of_python(functions):
    rng = np.random.default_rng(2)
    x = np.floor(spread(rng, 1.0, 2.0**53))
    y = rng.choice([67108859.0, 48.0, 2.0, 0.125, -7.0], len(x))
    x, y = np.append(x, [1e30, -3.0, 0.0, 2.0**60]), np.append(y, [7.0, 4.0, 3.0, 67108859.0])
    found = functions("moduli", x, y)
    assert found.tolist() == [float(a) % float(b) for a, b in zip(x, y, strict=True)]
    assert np.isnan(functions("moduli", [np.nan], [3.0]))


@together("lanes", FEATURES)
def test_the_c_compiles_without_warnings_for_every_number_of_lanes(tmp_path, lanes):
    assert library(tmp_path, lanes).stat().st_size > 0


AVX2, AVX512 = "avx avx2 fma", "avx512f avx512dq avx512vl"


@together(
    "system, machine, flags, lanes",
    [
        ("Linux", "x86_64", f"{AVX2} {AVX512}", 8),
        ("Linux", "x86_64", f"{AVX2} avx512f avx512dq", 4),
        ("Linux", "x86_64", "avx avx2", 0),
        ("Linux", "aarch64", AVX2, 0),
        ("Windows", "x86_64", AVX2, 0),
    ],
)
def test_their_number_is_that_of_the_processor(monkeypatch, system, machine, flags, lanes):
    monkeypatch.setattr(platform, "system", lambda: system)
    monkeypatch.setattr(platform, "machine", lambda: machine)
    monkeypatch.setattr(Path, "read_text", lambda *_, **__: f"processor\t: 0\nflags\t\t: fpu {flags}\nbugs\t\t:\n")
    assert lanes_here.__wrapped__() == lanes


def test_without_that_file_there_are_none(monkeypatch):
    def refused(*_, **__):
        raise PermissionError

    monkeypatch.setattr(platform, "system", lambda: "Linux")
    monkeypatch.setattr(Path, "read_text", refused)
    assert lanes_here.__wrapped__() == 0

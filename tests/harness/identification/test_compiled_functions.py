"""A function of CasADi becomes machine code that gives the same; it is kept, or done without."""

from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from driveline.harness.identification import compiled_functions
from driveline.harness.identification.compiled_functions import compiled

X = ca.SX.sym("x", 3)
FUNCTION = ca.Function("f", [X], [ca.exp(X[0]) * ca.sin(X) / (1.0 + ca.fabs(X[2])), ca.sqrt(ca.sumsqr(X))])
GIVEN = np.random.default_rng(1).normal(size=(3, 100))


@pytest.fixture
def kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where libraries are kept."""
    monkeypatch.setattr(compiled_functions, "user_cache", lambda: tmp_path / "cache")
    return tmp_path / "cache" / "functions"


def same(function: ca.Function) -> bool:
    found, expected = function.map(100)(GIVEN), FUNCTION.map(100)(GIVEN)
    return all(np.array_equal(np.asarray(a), np.asarray(b)) for a, b in zip(found, expected, strict=True))


def test_it_gives_the_same_bits(kept: Path) -> None:
    made = compiled(FUNCTION)
    assert made.class_name() == "External"
    assert same(made)
    assert sorted(path.suffix for path in kept.rglob("f.*")) == [".digest", ".so"]


def test_it_is_compiled_once(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    compiled(FUNCTION)
    monkeypatch.setattr(compiled_functions, "_compile", lambda *_: 1 // 0)
    assert same(compiled(FUNCTION))


def test_another_function_of_that_name_is_another_library(kept: Path) -> None:
    compiled(FUNCTION)
    other = compiled(ca.Function("f", [X], [2.0 * X]))
    np.testing.assert_array_equal(np.asarray(other(GIVEN[:, 0])).ravel(), 2.0 * GIVEN[:, 0])
    assert len(list(kept.glob("*/*.so"))) == 2


@pytest.mark.parametrize("compiler", ["no-such-compiler", "false"])
def test_without_a_compiler_that_works_it_remains_as_it_is(
    kept: Path, monkeypatch: pytest.MonkeyPatch, compiler: str
) -> None:
    monkeypatch.setenv("CC", compiler)
    assert compiled(FUNCTION) is FUNCTION
    assert not list(kept.rglob("f.*"))


def test_where_nothing_can_be_kept_it_remains_as_it_is(kept: Path) -> None:
    kept.parent.write_text("a file where a folder would be")
    assert compiled(FUNCTION) is FUNCTION


def test_a_library_that_is_cut_off_is_made_again(kept: Path) -> None:
    """Loaded, it would end the process with a bus error."""
    compiled(FUNCTION)
    (library,) = kept.glob("*/*.so")
    whole = library.read_bytes()
    library.unlink()  # this process has it in its memory
    library.write_bytes(whole[: len(whole) // 2])
    assert same(compiled(FUNCTION))
    assert library.read_bytes() == whole

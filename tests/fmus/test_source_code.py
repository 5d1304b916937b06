"""What of a source counts: FMUs are stale by their code, not by what is said of it."""

from pathlib import Path

import pytest
from fmutesting.together import together

from driveline.fmus.source_code import code_of
from fmublocks import origin

PYTHON = '''
"""Text."""
def torque(x, p):
    """Text."""
    twist = x.phi - p.phi_B  # text
    return [twist * k for k in range(3) if twist > 0.5]
'''
C = """
/* text */
static double torque(const State *x, double C)
{
    double twist = x->phi, *at = &twist; // text
    for (int k = 0; k < 3; k++)
        twist += 0.5 * k;
    return C * *at + x->twist;
}
"""

CASES = [
    ("block.py", PYTHON, ("Text", "Other words")),
    ("block.py", PYTHON, ('    """Text."""\n', "")),
    ("block.py", PYTHON, ("# text", "")),
    ("block.py", PYTHON, ("twist", "angle")),
    ("block.py", PYTHON, ("k", "n")),
    ("block.c", C, ("text", "other words")),
    ("block.c", C, ("double twist = x->phi", "double angle = x->phi"), ("&twist", "&angle"), ("  twist", "  angle")),
    ("block.c", C, ("*at", "*there")),
    ("block.c", C, ("k", "n")),
    ("block.toml", "k_d = 1.5\n", ("1.5", "1.50 # text")),
]


@together("name, source, changes", [(name, source, changes) for name, source, *changes in CASES])
def test_words_and_names_of_local_variables_do_not_count(tmp_path: Path, name, source, changes) -> None:
    assert changed(tmp_path / name, source, changes) == [False]


REAL = [
    (
        "block.py",
        PYTHON,
        [("0.5", "0.51"), ("phi_B", "phi_A"), ("- p", "+ p"), ("torque", "moment"), ("* k", "* twist")],
    ),
    ("block.py", "a = 1\nb = 2\n", [("a", "c"), ("1", "'1'"), ("1", "1.0"), ("a = 1\nb = 2", "b = 2\na = 1")]),
    (
        "block.py",
        "def f(a):\n    b = a\n    return b",
        [("f(a)", "f(a=1)"), ("return b", "return a"), ("b = a", "b = b")],
    ),
    ("block.py", "def f():\n    global G\n    G = 1", [("G", "H")]),
    ("block.py", "def f(b):\n    c = 1\n    return lambda c: c", [("lambda c: c", "lambda d: c")]),
    ("block.py", "class A:\n    b: int = 1\n    c: int = 2", [("b", "d"), ("int", "float")]),
    ("block.c", C, [("0.5", "0.51"), ("x->twist", "x->phi"), ("C * ", "C + "), ("*at", "*x"), ("double C", "float C")]),
    ("block.c", C, [("return C", "return twist"), ("k < 3", "k <= 3"), ("&twist", "&x")]),
    ("block.c", C + "static int turns;\n" + C.replace("torque", "twice"), [("turns", "rounds")]),
    ("block.c", "int f(int a)\n{\n    int b = g(a, c);\n    return b;\n}", [("c)", "d)"), ("(a, c", "(c, c")]),
    ("block.c", "struct A { double a; double b; };", [("double a; double b;", "double b; double a;")]),
    ("block.c", '#define A 1\nconst char *b = "/* c */";', [("A 1", "A 2"), ("/* c */", "/* d */")]),
    ("block.toml", "k_d = 1.5\n", [("1.5", "1.51"), ("k_d", "k_e")]),
]


@together("name, source, changes", REAL)
def test_whatever_else_changes_counts(tmp_path: Path, name, source, changes) -> None:
    found = [changed(tmp_path / name, source, [change]) for change in changes]
    assert found == [[True]] * len(changes), list(zip(changes, found, strict=True))


def changed(path: Path, source: str, changes) -> list[bool]:
    """Whether the code is another one after these replacements."""
    path.write_text(source)
    before = code_of(path)
    for old, new in changes:
        assert old in source
        source = source.replace(old, new)
    path.write_text(source)
    return [code_of(path) != before]


def test_the_digest_is_kept_by_the_bytes_of_the_sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = origin.sources_digest.__wrapped__
    monkeypatch.setattr(origin, "user_cache", lambda: tmp_path)
    now = asked()
    (kept,) = (tmp_path / "sources").iterdir()
    monkeypatch.setattr("driveline.fmus.source_code.code_of", lambda path: "others")
    assert asked() == now
    kept.write_text("damaged by something")
    other = asked()
    assert other != now
    assert asked() == other
    assert len(list((tmp_path / "sources").iterdir())) == 1


def test_a_cache_that_cannot_be_written_costs_time_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now = origin.sources_digest()
    (tmp_path / "file").touch()
    monkeypatch.setattr(origin, "user_cache", lambda: tmp_path / "file")
    assert origin.sources_digest.__wrapped__() == now

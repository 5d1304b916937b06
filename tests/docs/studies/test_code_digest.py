"""What computes nothing is not in the digest of code."""

from pathlib import Path

import pytest

from docs.studies.code_digest import digest

CODE = '''"""A sum."""
from typing import Any
from a import b

def total(x: float, y: float) -> float:
    """Of both."""
    return b(x) + y  # plain
'''


def as_if(text: str, folder: Path, name: str = "code.py") -> str:
    """The digest of a file with this text."""
    path = folder / str(len(list(folder.iterdir()))) / name
    path.parent.mkdir()
    path.write_text(text, encoding="utf-8")
    return digest(path)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("A sum", "The sum of two numbers"),
        ("  # plain", ""),
        ("b(x) + y", "(\n        b(x)\n        + y\n    )"),
        ("x: float, y: float) -> float", "x, y)"),
        ("import Any", "import Any, NamedTuple"),
        ("from a import", "from .c import"),
    ],
)
def test_what_computes_nothing_does_not_count(before: str, after: str, tmp_path: Path) -> None:
    assert before in CODE
    assert as_if(CODE, tmp_path) == as_if(CODE.replace(before, after), tmp_path)


@pytest.mark.parametrize(("before", "after"), [("+ y", "- y"), ("b(x)", "b(y)"), ("import b", "import b, c")])
def test_what_computes_counts(before: str, after: str, tmp_path: Path) -> None:
    assert as_if(CODE, tmp_path) != as_if(CODE.replace(before, after), tmp_path)


def test_a_field_that_is_declared_by_its_annotation_counts(tmp_path: Path) -> None:
    field = 'class Input:\n    T_mot: Annotated[float, Real("N.m", minimum={})]\n'
    assert as_if(field.format(0), tmp_path) != as_if(field.format(1), tmp_path)


def test_of_c_comments_and_layout_do_not_count_and_all_else_does(tmp_path: Path) -> None:
    c = 'x = y + 1; /* one\nmore */ puts("/* two  */");'
    assert as_if(c, tmp_path, "a.c") == as_if(
        'x =\n  y + 1; puts("/* two  */");'.replace("; p", "; /**/ p"), tmp_path, "a.c"
    )
    assert as_if(c, tmp_path, "a.c") != as_if(c.replace("two ", "two"), tmp_path, "a.c")
    assert as_if(c, tmp_path, "a.c") != as_if(c.replace("1", "2"), tmp_path, "a.c")

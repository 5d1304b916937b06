"""A program with the controller behind a link: compiled, or refused by name."""

from pathlib import Path

import pytest

from driveline.fmus.native.compiler import CompilerError
from driveline.fmus.target.image import host_program


def test_what_the_compiler_refuses_is_told_as_it_says_it(tmp_path: Path) -> None:
    with pytest.raises(CompilerError, match=r"wrong\.c.*\n(.*\n)*.*nothing"):
        host_program({"wrong.c": "int value(void) { return nothing; }\n"}, tmp_path)

"""The page of scores says what was run, and of no code that has changed since; a sample is what its seed says."""

from pathlib import Path

import pytest
from mutants import Mutant
from page import PATH, changed, gone, page, reasons
from sample import LEAST, _lot, shares


def test_the_page_is_not_older_than_the_code_it_speaks_of() -> None:
    """`make mutation` tries the faults of files anew that have changed; `python tests/mutation/page.py` only takes
    their numbers out of the page."""
    assert PATH.read_text(encoding="utf-8") == page(), f"changed since they were run: {changed()}"


def test_what_is_explained_can_be() -> None:
    assert gone({file for file, _, _ in reasons()}) == set(), "in tests/mutation/survivors.toml: these go"


@pytest.mark.parametrize("size", [40, 200, 201])
def test_every_room_gets_some_faults_and_the_others_go_by_lines(size: int) -> None:
    lines = {"tiny": 1, "small": 990, "large": 9009}
    found = shares(lines, size)
    assert sum(found.values()) == size
    assert found["tiny"] in (LEAST, LEAST + 1)
    for room in ("small", "large"):
        assert found[room] - LEAST == pytest.approx((size - 3 * LEAST) * lines[room] / 10_000, abs=1.0)


def test_what_is_drawn_depends_on_the_seed_and_not_on_where_a_line_stands() -> None:
    one = Mutant("harness/loop.py", 3, 40, "x = 1.0", "1.0", "1.2")
    assert _lot(one, 1) == _lot(one._replace(file="harness/base/loop.py", line=9, place=99), 1)
    assert _lot(one, 1) != _lot(one, 2)
    assert _lot(one, 1) != _lot(one._replace(new="0.8"), 1)


def test_a_fault_leaves_the_file_as_it_was(tmp_path: Path) -> None:
    file = tmp_path / "file.py"
    file.write_text("x = 1.0\n", encoding="utf-8")
    before = file.stat().st_mtime_ns
    with Mutant("file.py", 1, 4, "x = 1.0", "1.0", "1.2").applied(tmp_path):
        assert file.read_text(encoding="utf-8") == "x = 1.2\n"
        assert file.stat().st_mtime_ns != before
    assert (file.read_text(encoding="utf-8"), file.stat().st_mtime_ns) == ("x = 1.0\n", before)

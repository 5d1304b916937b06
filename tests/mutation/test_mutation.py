"""A sample is what its seed says, and a fault leaves the file as it was."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from driveline.fmus.catalogue import FMUS
from tests.mutation.covering import CALLS, IN_C, LAST, own, rounds
from tests.mutation.mutants import LEAST, ROOT, Mutant, not_copied, rooms, shares
from tests.mutation.remembering import remembered

ONE = Mutant("code.py", 1, 4, "x = 1.0", "1.0", "1.2")


@pytest.mark.parametrize("size", [40, 200, 201])
def test_every_room_gets_some_faults_and_the_others_go_by_lines(size: int) -> None:
    lines = {"tiny": 1, "small": 990, "large": 9009}
    found = shares(lines, size)
    assert sum(found.values()) == size
    assert found["tiny"] in (LEAST, LEAST + 1)
    for room in ("small", "large"):
        assert found[room] - LEAST == pytest.approx((size - 3 * LEAST) * lines[room] / 10_000, abs=1.0)


def test_what_is_drawn_depends_on_the_seed_and_not_on_where_a_line_stands() -> None:
    assert ONE.lot(1) == ONE._replace(file="harness/loop/code.py", line=9, place=99).lot(1)
    assert ONE.lot(1) != ONE.lot(2)
    assert ONE.lot(1) != ONE._replace(new="0.8").lot(1)


def test_the_tests_of_the_file_itself_are_run_first() -> None:
    for file in [file for files in rooms().values() for file in files][::20]:
        first, *others = rounds(file) or [[]]
        assert not (file.endswith(".py") and own(file)) or first == own(file)
        assert not set(first) & {test for tests in others for test in tests}


def test_all_tests_that_are_named_exist() -> None:
    named = [*CALLS, *LAST.values(), *(test for tests in IN_C.values() for test in tests)]
    assert [test for test in named if not (ROOT / test.partition("::")[0]).is_file()] == []


def test_a_result_is_computed_once_for_the_same_arguments_of_a_block_of_the_project(tmp_path: Path) -> None:
    calls = []

    def made(fmu: Any, *others: int, **named: int) -> int:
        calls.append((others, named))
        return len(calls)

    ask, ours = remembered(made, tmp_path), FMUS["WheelSpeedCan"]
    assert [ask(ours, 1, sends=2), ask(ours, 1, sends=2), ask(ours, 1, sends=3), ask(ours, 2)] == [1, 1, 2, 3]
    theirs = replace(ours, block=replace(ours.block, module="their_car"))
    assert [ask(theirs), ask(theirs)] == [4, 5]


def test_a_copy_has_all_that_tests_import_and_nothing_that_was_made() -> None:
    tree = [".git", "build", "docs", "driveline_damping.egg-info", "site", "tests"]
    assert not_copied(str(ROOT), tree) == {".git", "build", "driveline_damping.egg-info", "site"}
    assert not not_copied(str(ROOT / "docs"), ["site", "studies"])


def test_a_fault_leaves_the_file_as_it_was(tmp_path: Path) -> None:
    file = tmp_path / "code.py"
    file.write_text("x = 1.0\n", encoding="utf-8")
    before = file.stat().st_mtime_ns
    with ONE.applied(tmp_path):
        assert file.read_text(encoding="utf-8") == "x = 1.2\n"
        assert file.stat().st_mtime_ns != before
    assert (file.read_text(encoding="utf-8"), file.stat().st_mtime_ns) == ("x = 1.0\n", before)

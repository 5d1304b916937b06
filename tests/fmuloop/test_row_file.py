"""A long run is in a file: the same results, metrics and figure, and in memory no more than a piece of them."""

import errno
import os
import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.simulation.simulate import simulate
from driveline.harness.views.figure_options import FigureOptions
from driveline.harness.views.run_figure import plot_run
from fmuloop import experiment, results, row_file
from fmuloop.results import Results
from fmuloop.row_file import RowFile, zeros

TIPIN = replace(MANOEUVRES["tipin15"], duration=2.5)
PNG = FigureOptions(kinds=("png",))


@pytest.fixture
def in_files(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every run is long."""
    monkeypatch.setattr(row_file, "MOST_IN_MEMORY", 0)
    for module in (row_file, results):
        monkeypatch.setattr(module, "RESIDENT", 2**14)
    monkeypatch.setattr(experiment, "AT_ONCE", 100)


def test_rows_up_to_a_size_are_in_memory_and_more_in_a_file(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(row_file, "MOST_IN_MEMORY", 800)
    assert zeros(100, np.dtype(float))[1] is None
    rows, file = zeros(101, np.dtype(float))
    assert file is not None
    assert not rows.any()


@pytest.mark.slow
def test_a_run_in_a_file_is_the_same(native: Path, in_files: None, tmp_path: Path) -> None:
    with pytest.MonkeyPatch.context() as short:
        short.setattr(row_file, "MOST_IN_MEMORY", 2**26)
        short.setattr(experiment, "AT_ONCE", 2**18)
        expected = simulate(TIPIN, folder=native.parent)
    found = simulate(TIPIN, folder=native.parent)
    assert (expected.file is None, found.file is None) == (True, False)
    np.testing.assert_array_equal(found, expected)
    assert found.units == expected.units
    for piece in (slice(7, 900), slice(None, None, 3), slice(None, None, -1)):
        for name in found.dtype.names or ():
            np.testing.assert_array_equal(found[piece][name], expected[piece][name])
    assert evaluate(found, TIPIN) == evaluate(expected, TIPIN)
    drawn = [plot_run(run, TIPIN, "a run", tmp_path / f"{k}", PNG) for k, run in enumerate((found, expected))]
    assert len({figure.read_bytes() for figures in drawn for figure in figures}) == len(drawn[0])


def test_a_column_of_a_run_in_a_file_is_a_copy_that_takes_its_own_memory_alone(native: Path, in_files: None) -> None:
    run = simulate(TIPIN, folder=native.parent)
    with pytest.raises(ValueError, match="read-only"):
        run["plant.T_gear"][0] = 1.0
    run["plant.T_gear"] = 1.0
    assert (run["plant.T_gear"] == 1.0).all()
    rows, file = zeros(10_000, np.dtype([(f"x{k}", float) for k in range(20)]))
    run = Results(rows, {}, file)
    tracemalloc.start()
    try:
        column = run["x3"]
        assert tracemalloc.get_traced_memory()[1] < 1.2 * column.nbytes
    finally:
        tracemalloc.stop()


def test_what_has_been_read_or_written_is_given_back(monkeypatch: pytest.MonkeyPatch, in_files: None) -> None:
    given_back: list[int] = []
    rows, file = zeros(4096, np.dtype([("a", float), ("b", float)]))
    assert file is not None
    memory = file.memory

    class Watched:
        def madvise(self, how: int) -> None:
            given_back.append(how)
            memory.madvise(how)

    monkeypatch.setattr(file, "memory", Watched())
    run = Results(rows, {}, file)
    run["b"] = np.arange(4096.0)
    np.testing.assert_array_equal(run["b"], np.arange(4096.0))
    assert len(given_back) == 4, "once in 16 KiB"
    np.testing.assert_array_equal(run["b"], np.arange(4096.0))
    assert len(given_back) == 8


def test_nothing_of_a_file_can_be_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    file = RowFile(8192)
    file.memory[8191] = 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not hasattr(os, "posix_fallocate"), reason="room is not asked for there")
def test_a_disk_without_room_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(os, "posix_fallocate", full)
    with pytest.raises(MemoryError, match=r"^a run with 8e-06 GB of results: No space left on device in /.*TMPDIR"):
        RowFile(8000)

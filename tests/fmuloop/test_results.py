"""The signals of a run know their units, whatever is taken of them, and become a frame of pandas."""

import copy
import pickle
from dataclasses import replace
from pathlib import Path

import cloudpickle
import numpy as np
import pandas as pd
import pytest
from numpy.lib.recfunctions import repack_fields

from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from driveline.harness.views.signals_file import write_signals
from fmuloop.many_runs import run_many
from fmuloop.results import Results

TIPIN = replace(MANOEUVRES["tipin15"], duration=0.2)

UNITS = {
    "time": "s",
    "controller.T_driver": "N.m",
    "plant.T_gear": "N.m",
    "plant.omega_1": "rad/s",
    "plant.slope": "rad",
    "can.omega_2_can": "rad/s",
}


@pytest.fixture(scope="module")
def results(native: Path) -> Results:
    return simulate(TIPIN, folder=native.parent)


def test_it_has_the_columns_that_it_has(results: Results) -> None:
    assert "plant.T_gear" in results
    assert "T_gear" not in results
    assert 0.1 in results["time"]


def same(found: Results, expected: Results) -> bool:
    return type(found) is Results and found.units == expected.units and np.array_equal(found, expected)


def test_a_run_its_rows_and_columns_know_their_units(results: Results) -> None:
    assert UNITS.items() <= results.units.items()
    assert "can.counter" not in results.units
    columns = ["time", "plant.T_gear"]
    for piece in (results[::2], results[results["time"] > 0.1], results[columns], repack_fields(results[columns])):
        assert type(piece) is Results
        assert piece.units == results.units
    torque = results["plant.T_gear"]
    assert type(torque) is np.ndarray
    assert np.shares_memory(torque, results)


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda it: pickle.loads(cloudpickle.dumps(it))])
def test_a_copy_is_the_same(results: Results, again) -> None:
    assert same(again(results), results)
    assert same(again(results[::2]), results[::2].copy())


def test_runs_of_other_processes_know_them(results: Results, native: Path) -> None:
    runs = run_many(lambda seed: simulate(TIPIN, seed=seed, folder=native.parent), [1, 2], workers=2)
    assert same(runs[0], results)
    apart = simulate(TIPIN, native / "TwoMassDriveline.fmu", folder=native.parent)
    assert same(apart, results)


def test_a_frame_has_the_signals_over_the_time_with_their_units_and_is_no_view(
    results: Results, tmp_path: Path
) -> None:
    frame = results.to_pandas()
    assert frame.attrs["units"] == results.units
    np.testing.assert_array_equal(frame.index, results["time"])
    assert frame.index.name == "time"
    assert list(frame) == list(results.dtype.names or ())[1:]
    for name in frame:
        np.testing.assert_array_equal(frame[name], results[name])
        assert frame[name].dtype == results.dtype[name]
    assert results[["time", "plant.T_gear"]].to_pandas().attrs["units"] == {"time": "s", "plant.T_gear": "N.m"}
    frame, before = results.to_pandas(), results["plant.T_gear"].copy()
    frame["plant.T_gear"] += 1.0
    np.testing.assert_array_equal(results["plant.T_gear"], before)
    read = pd.read_parquet(write_signals(results, tmp_path / "run", "parquet"))
    assert read.attrs == results.to_pandas().attrs
    pd.testing.assert_frame_equal(read.set_index("time"), results.to_pandas())

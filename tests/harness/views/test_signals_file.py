"""The signals of a run in every format: read again they are the same, by us and by the libraries of the trade."""

import sys
from pathlib import Path

import numpy as np
import pytest
from fmpy.util import read_csv

from driveline.harness.views import signals_file
from driveline.harness.views.signals_file import FORMATS, require_format, signals_path, write_signals
from driverecords.channels import Channels
from driverecords.format_detection import opened
from fmuloop.results import Results
from toolground.errors import MissingExtra

UNITS = {"time": "s", "plant.v": "m/s", "plant.T_gear": "N.m", "controller.T_driver": "N.m", "plant.phi": "rad"}


def run() -> Results:
    """Numbers that short decimals do not hold, flags and counters."""
    k = np.arange(501)
    columns = {
        "time": k * 1e-3,
        "plant.v": 4.0 + 0.1 * np.sin(k / 7.0),
        "plant.T_gear": 100.0 * np.cos(k / 11.0) / 3.0,
        "controller.T_driver": np.where(k < 100, -12.0, 100.0),
        "plant.phi": 1e-9 * k / 3.0,
        "can.valid": k > 20,
        "can.counter": (k // 20).astype(np.int32),
    }
    results = np.empty(len(k), dtype=[(name, values.dtype) for name, values in columns.items()])
    for name, values in columns.items():
        results[name] = values
    return Results(results, UNITS)


RESULTS = run()


@pytest.mark.parametrize("name", FORMATS)
def test_what_is_written_is_read_again_with_its_times_and_units(tmp_path: Path, name: str) -> None:
    source = opened(write_signals(RESULTS, tmp_path / "run", name))
    others = [column for column in RESULTS.dtype.names or () if not (source.own_time and column == "time")]
    assert [column.name for column in source.columns] == others
    for column, samples in zip(source.columns, source.read(range(len(others))), strict=True):
        np.testing.assert_array_equal(samples.values, RESULTS[column.name].astype(float), err_msg=column.name)
        if source.own_time:
            np.testing.assert_array_equal(samples.time, RESULTS["time"])
        if name != "csv":  # whose units stand in the record beside it
            assert column.unit == UNITS.get(column.name)


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("rows", [100, 167])
def test_what_is_written_piece_by_piece_is_read_again(
    tmp_path: Path, name: str, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(signals_file, "ROWS_AT_ONCE", rows)
    test_what_is_written_is_read_again_with_its_times_and_units(tmp_path, name)


@pytest.mark.parametrize("name", [name for name in FORMATS if name != "csv"])
def test_quantities_are_found_in_si_units_without_any_other_file(tmp_path: Path, name: str) -> None:
    channels = Channels(write_signals(RESULTS, tmp_path / "run", name)).read("v", "T_driver", "valid", "counter")
    for quantity, column in {"v": "plant.v", "T_driver": "controller.T_driver", "counter": "can.counter"}.items():
        np.testing.assert_array_equal(channels[quantity].time, RESULTS["time"])
        np.testing.assert_array_equal(channels[quantity].values, RESULTS[column])


@pytest.mark.parametrize("name", FORMATS)
def test_the_same_signals_give_the_same_bytes_and_nothing_else_is_left(tmp_path: Path, name: str) -> None:
    first = write_signals(RESULTS, tmp_path / "run", name).read_bytes()
    assert write_signals(RESULTS, tmp_path / "run", name).read_bytes() == first
    assert list(tmp_path.iterdir()) == [signals_path(tmp_path / "run", name)]


@pytest.mark.parametrize("name", FORMATS)
def test_every_other_row_of_an_array_is_written_too(tmp_path: Path, name: str) -> None:
    source = opened(write_signals(RESULTS[::5], tmp_path / "run", name))
    place = [column.name for column in source.columns].index("plant.T_gear")
    np.testing.assert_array_equal(source.read([place])[0].values, RESULTS["plant.T_gear"][::5])


def test_units_in_the_names_of_columns_are_units_in_every_format(tmp_path: Path) -> None:
    recorded = RESULTS[["time", "plant.v"]].astype([("Time [s]", float), ("Velocity [m/s]", float)])
    for name in FORMATS:
        column = opened(write_signals(recorded, tmp_path / name, name)).columns[-1]
        assert (column.name, column.unit) == ("Velocity", "m/s")


def test_asammdf_finds_channels_units_and_one_time(tmp_path: Path) -> None:
    from asammdf import MDF

    with MDF(write_signals(RESULTS, tmp_path / "run", "mf4")) as file:
        assert file.version == "4.10"
        torque = file.get("plant.T_gear")
        assert torque.unit == "N.m"
        np.testing.assert_array_equal(torque.samples, RESULTS["plant.T_gear"])
        np.testing.assert_array_equal(torque.timestamps, RESULTS["time"])
        np.testing.assert_array_equal(file.get("can.counter").samples, RESULTS["can.counter"])


def test_pandas_finds_numbers_kinds_and_units_in_parquet(tmp_path: Path) -> None:
    import pandas as pd

    frame = pd.read_parquet(write_signals(RESULTS, tmp_path / "run", "parquet"))
    assert frame.attrs["units"] == UNITS
    for column in RESULTS.dtype.names or ():
        np.testing.assert_array_equal(frame[column], RESULTS[column])
        assert frame[column].dtype == RESULTS.dtype[column]


def test_fmpy_and_pandas_read_both_kinds_of_csv(tmp_path: Path) -> None:
    import pandas as pd

    plain, units = (write_signals(RESULTS, tmp_path / name, name) for name in ("csv", "csv-units"))
    np.testing.assert_array_equal(read_csv(plain)["plant.T_gear"], RESULTS["plant.T_gear"])
    np.testing.assert_array_equal(pd.read_csv(units)["plant.T_gear [N.m]"], RESULTS["plant.T_gear"])


@pytest.mark.parametrize("name", ["parquet", "mf4"])
def test_without_the_extra_it_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.setitem(sys.modules, str(FORMATS[name].package), None)
    for attempt in (lambda: require_format(name), lambda: write_signals(RESULTS, tmp_path / "run", name)):
        with pytest.raises(MissingExtra, match=r"the extra `recordings`, as in pip install"):
            attempt()
    assert not list(tmp_path.iterdir())

"""Arguments of another kind are refused by name, by every public function."""

from typing import Any

import numpy as np
import pytest

import driveline
from fmuloop.argument_kinds import require_each
from fmuloop.errors import WiringError

TIPIN = driveline.MANOEUVRES["tipin15"]
RESULTS = np.zeros(3)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: driveline.evaluate(TIPIN, RESULTS), "results = Manoeuvre.*: it must be results of a run"),  # type: ignore[arg-type]
        (lambda: driveline.evaluate(RESULTS, "tipin15"), "manoeuvre = 'tipin15': it must be a Manoeuvre"),  # type: ignore[arg-type]
        (lambda: driveline.compare("tipin15"), "manoeuvres = 'tipin15': it must be a list of manoeuvres"),  # type: ignore[arg-type]
        (lambda: driveline.compare(TIPIN), "manoeuvres = Manoeuvre.*: it must be a list of manoeuvres"),  # type: ignore[arg-type]
        (lambda: driveline.compare(["tipin15"]), "one of manoeuvres = 'tipin15': it must be"),  # type: ignore[list-item]
        (lambda: driveline.compare([TIPIN], "TwoMassDriveline"), "plants = 'TwoMassDriveline': it must be a list of"),
        (lambda: driveline.analyse("TwoMassDriveline"), "plants = 'TwoMassDriveline': it must be a list of names"),
        (lambda: driveline.replay("trip.csv"), "drive = 'trip.csv': it must be a Drive, as read_drive reads it"),  # type: ignore[arg-type]
        (lambda: driveline.identify("test.csv"), "recording = 'test.csv': it must be a Measurement"),  # type: ignore[arg-type]
        (lambda: driveline.simulate(TIPIN, step_size=float("nan")), "step_size = nan: it must be a number of seconds"),
        (lambda: driveline.Settings(step_size=0.0), "step_size = 0.0: it must be a number of seconds above 0"),
        (lambda: driveline.Settings(step_size=-1e-3), "step_size = -0.001: it must be a number of seconds above 0"),
        (lambda: driveline.Settings(step_size=float("inf")), "step_size = inf: it must be a number of seconds above 0"),
        (lambda: driveline.Settings(seed=-1), "seed = -1: it must be a whole number from 0 on"),
        (lambda: driveline.Limits(call=float("nan")), "Limits, call = nan: it must be a number above 0"),
        (lambda: driveline.Limits(unpacked=0), "Limits, unpacked = 0: it must be a number above 0"),
    ],
)
def test_it_is_named_with_what_is_allowed(call: Any, message: str) -> None:
    with pytest.raises(WiringError, match=f"^{message}"):
        call()


def test_what_is_just_allowed_is_taken() -> None:
    made = driveline.Settings(step_size=5e-324, seed=0, limits=driveline.Limits(call=5e-324, unpacked=1))
    assert (made.step_size, made.seed) == (5e-324, 0)
    assert require_each("plants", (name for name in "ab"), str, "names") == ["a", "b"]


def test_a_path_may_be_a_text() -> None:
    for read in (driveline.read_drive, driveline.read_manoeuvre, driveline.read_vehicle):
        with pytest.raises(
            (driveline.DrivelineError, driveline.ParameterFileError), match=r"there is no .*nothing\.toml|no such file"
        ):
            read("nothing.toml")  # type: ignore[arg-type]

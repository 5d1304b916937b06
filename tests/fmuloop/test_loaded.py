"""Loops that are loaded once, or kept from run to run: each run is that of a fresh one, whatever was run before."""

from dataclasses import replace
from shutil import copyfile

import numpy as np
import pytest
from fmutesting.foreign import SMALLEST_CONTROLLER, build_relay
from fmutesting.slow import slow

from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import signals, start
from fmuloop import loading, runs
from fmuloop.errors import SimulationError, WiringError
from fmuloop.experiment import Experiment
from fmuloop.loading import loaded
from fmuloop.runs import MOST_KEPT, kept_loaded, run
from fmuloop.system import Connection, Scheme, System

TIPIN = replace(MANOEUVRES["tipin15"], duration=1.2)
LAUNCH = replace(MANOEUVRES["launch"], duration=0.3)


def drive(running, manoeuvre=TIPIN, step_size=1e-3, scheme=Scheme.PROPAGATED, **changes):
    parameters = start(manoeuvre) | {name.replace("__", "."): value for name, value in changes.items()}
    return running.run(Experiment(manoeuvre.duration, step_size, signals(manoeuvre), parameters, scheme))


BUILDS = [(plant, build) for plant in PLANTS for build in ("native", "python")]


@pytest.mark.parametrize(("plant", "build"), slow(BUILDS, but={*BUILDS} - {("ValidationVehicle", "python")}))
def test_a_further_run_is_that_of_a_fresh_loop(both_built, plant, build):
    system = loop(plant, folder=both_built, build=build)
    with loaded(system) as running:
        fresh = drive(running)
        drive(running, LAUNCH, 2e-3, Scheme.JACOBI, plant__phi_B=0.3, motor__seed=7, controller__k_d=0.0)
        np.testing.assert_array_equal(drive(running), fresh)
    with loaded(system) as running:
        other = drive(running, LAUNCH)
    with loaded(system) as running:
        drive(running)
        np.testing.assert_array_equal(drive(running, LAUNCH), other)


def test_a_loop_whose_run_was_refused_stays_usable(both_built):
    system = loop(PLANTS[0], folder=both_built, build="native")
    too_large = replace(TIPIN, slope=lambda t: np.where(t < 0.5, 0.0, 0.6))
    with loaded(system) as running:
        fresh = drive(running)
        with pytest.raises(SimulationError, match=r"phi_B = -1"):
            drive(running, plant__phi_B=-1.0)
        np.testing.assert_array_equal(drive(running), fresh)
        with pytest.raises(SimulationError, match=r"^plant .* at 0\.5 s .*slope = 0\.6"):
            drive(running, too_large)
        np.testing.assert_array_equal(drive(running), fresh)
        with pytest.raises(WiringError, match="no parameter phi_b; did you mean phi_B"):
            drive(running, plant__phi_b=0.1)
        with pytest.raises(WiringError, match="steps must be longer than 0 s"):
            drive(running, step_size=0.0)
        np.testing.assert_array_equal(drive(running), fresh)


def test_each_run_has_its_own_inputs_and_results(relay):
    # And those that are the same as before are set again: reset has put them back to their start.
    with loaded(System({"a": relay})) as running:
        for inputs, expected in (({"a.u": 5.0}, 5.0), ({"a.u": 5.0}, 5.0), ({}, 0.0), ({"a.u": 5.0, "a.n": 1}, 5.0)):
            results = running.run(Experiment(0.01, inputs=inputs))
            assert (results["a.y"][1:] == expected).all()
            assert ("a.u" in (results.dtype.names or ())) == ("a.u" in inputs)
    with loaded(System({"a": relay})) as running:
        first = running.run(Experiment(0.01, inputs={"a.u": 1.0}))
        running.run(Experiment(0.01, inputs={"a.u": 2.0}))
    assert (first["a.u"] == 1.0).all()
    assert (first["a.y"][1:] == 1.0).all()


@pytest.mark.parametrize("value", [0.5, 2.0**31, -(2.0**31), float("nan"), float("inf")])
def test_what_an_integer_does_not_hold_is_refused(relay, value):
    with loaded(System({"a": relay})) as running:
        running.run(Experiment(0.01, parameters={"a.count": 2.0**31 - 1}))
        with pytest.raises(WiringError, match=rf"a\.count = {value:g}: it must be a whole number".replace("+", r"\+")):
            running.run(Experiment(0.01, parameters={"a.count": value}))


def test_fatal_and_refusals_are_told_of_the_run_that_they_were_in(relay):
    with loaded(System({"a": relay})) as running:
        with pytest.raises(WiringError, match=r"a\.count = 0\.5: it must be a whole number"):
            running.run(Experiment(0.01, parameters={"a.count": 0.5}))
        running.run(Experiment(0.01))
        with pytest.raises(SimulationError) as refusal:
            running.run(Experiment(0.01, inputs={"a.u": 3.0}, parameters={"a.limit": 2.0}))
    assert str(refusal.value).count("is beyond") == 1
    system = System({"a": relay, "b": relay}, (Connection("a.y", "b.u"),))
    with loaded(system) as running:
        with pytest.raises(SimulationError, match="with fatal"):
            running.run(Experiment(0.01, inputs={"a.u": 3.0}, parameters={"b.limit": 2.0}))
        with pytest.raises(SimulationError, match=r"b \(Relay\.fmu\) has ended with fatal; load it anew"):
            running.run(Experiment(0.01))
    assert (run(system, Experiment(0.01, inputs={"a.u": 3.0}))["b.y"][2:] == 3.0).all()


def test_nothing_is_left_behind(relay, unpacked):
    with loaded(System({"a": relay, "b": relay})) as running:
        for _ in range(3):
            running.run(Experiment(0.01))
        assert len(files(unpacked)) == 1
    assert files(unpacked) == []


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("a.b", 0.5, r"a\.b = 0\.5: it must be true \(1\) or false \(0\)"),
        ("a.b", np.nan, r"a\.b = nan: it must be true"),
        ("a.b", "yes", r"a\.b = yes: an input is a number"),
        ("a.n", 0.5, r"a\.n = 0\.5: it must be a whole number of less than 2\^31"),
        ("a.n", 2**31, r"a\.n = 2\.14748e\+09: it must be a whole number"),
        ("a.n", np.inf, r"a\.n = inf: it must be a whole number"),
        ("a.u", "1.0", r"a\.u = 1\.0: an input is a number"),
        ("a.u", [None] * 11, r"a\.u = None: an input is a number"),
    ],
)
def test_an_input_gets_what_suits_its_type(relay, name, value, message):
    with loaded(System({"a": relay})) as running:
        with pytest.raises(WiringError, match=message):
            running.run(Experiment(0.01, inputs={name: value}))
        assert len(running.run(Experiment(0.01, inputs={"a.b": 1.0, "a.n": 2**31 - 1, "a.u": True}))) == 11


def test_that_the_steps_run_in_python_is_said_once(relay, monkeypatch, caplog):
    monkeypatch.setattr(loading, "why_not", lambda: "the steps are old")
    for _ in range(2):
        with loaded(System({"a": relay})):
            pass
    assert caplog.messages.count("the steps are old") == 1


def files(folder):
    return sorted(path.name for path in folder.iterdir())


def gains(system, *values):
    cases = [Experiment(0.01, inputs={"a.u": 1.0}, parameters={"a.gain": value}) for value in values]
    return [run(system, case)["a.y"][-1] for case in cases]


def test_a_system_is_kept_loaded_and_unloaded_in_the_end(relay, unpacked):
    system = System({"a": relay})
    with kept_loaded():
        assert gains(system, 2.0) == [2.0]
        first = files(unpacked)
        assert len(first) == 1
        assert gains(System({"a": relay}), 3.0, 4.0) == [3.0, 4.0]
        assert files(unpacked) == first
    assert files(unpacked) == []
    assert gains(system, 5.0) == [5.0]
    assert files(unpacked) == []


def test_a_file_that_has_changed_is_loaded_anew(native, tmp_path):
    block = tmp_path / "block.fmu"
    copyfile(native / "MotorTorqueLoop.fmu", block)
    with kept_loaded():
        assert "block.T_mot" in (run(System({"block": block}), Experiment(0.01)).dtype.names or ())
        copyfile(native / "WheelSpeedCan.fmu", block)
        assert "block.counter" in (run(System({"block": block}), Experiment(0.01)).dtype.names or ())
        block.unlink()
        with pytest.raises(WiringError, match="there is no FMU"):
            run(System({"block": block}), Experiment(0.01))


@pytest.mark.slow
def test_only_the_last_ones_are_kept(relay, unpacked):
    systems = [System({f"a{k}": relay}) for k in range(MOST_KEPT + 1)]
    with kept_loaded():
        for system in systems[:-1]:
            run(system, Experiment(0.01))
        first, *others = unpacked.iterdir()
        first = min((first, *others), key=lambda path: path.stat().st_ctime_ns).name
        assert len(others) == MOST_KEPT - 1
        run(systems[0], Experiment(0.01))
        assert first in files(unpacked)
        run(systems[-1], Experiment(0.01))
        assert len(files(unpacked)) == MOST_KEPT
        assert first in files(unpacked)


def test_errors_are_told_in_every_run_and_unload_or_load_anew(relay, unpacked):
    system = System({"a": relay})
    with kept_loaded():
        gains(system, 1.0)
        with pytest.raises(SimulationError, match="with fatal"):
            run(system, Experiment(0.01, inputs={"a.u": 3.0}, parameters={"a.limit": 2.0}))
        assert gains(system, 7.0) == [7.0]
        assert len(files(unpacked)) == 1
    with kept_loaded():
        for _ in range(2):
            with pytest.raises(WiringError, match="no parameter gian; did you mean gain"):
                run(System({"a": relay}), Experiment(0.01, parameters={"a.gian": 1.0}))
            gains(System({"a": relay}), 1.0)
    with pytest.raises(SimulationError), kept_loaded():
        run(System({"a": relay}), Experiment(0.01, inputs={"a.u": 3.0}, parameters={"a.limit": 2.0}))
    assert files(unpacked) == []
    assert runs._here.kept is None


def test_ours_run_from_a_folder_that_is_not_ascii_and_of_others_that_cannot_the_folder_is_named(native, tmp_path):
    """PythonFMU's binary does not decode the URI of its resources, and crashes."""
    folder = tmp_path / "Fahrzeuge für Anfänger"
    folder.mkdir()
    with loaded(System({"motor": native / "MotorTorqueLoop.fmu"}, own=frozenset({"motor"})), folder=folder) as ours:
        assert len(ours.run(Experiment(0.01))) == 11
    theirs = System({"a": build_relay(tmp_path, SMALLEST_CONTROLLER)})
    message = r"it was unpacked to .*, whose name is not plain ASCII"
    with pytest.raises(SimulationError, match=message), loaded(theirs, folder=folder):
        pass
    assert list(folder.iterdir()) == []

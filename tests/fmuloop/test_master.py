"""The master: when outputs reach inputs, what time it is, what it leaves behind."""

from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest
from fmpy.util import read_csv
from fmutesting.host import opened

from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmuloop.errors import SimulationError, WiringError
from fmuloop.experiment import Experiment, instants, memory
from fmuloop.runs import run
from fmuloop.system import Connection, Scheme, System
from toolground.csv_file import write_csv


@pytest.fixture
def chain(relay):
    """Three relays in a row, stepped from the first to the last."""
    return System({"a": relay, "b": relay, "c": relay}, (Connection("a.y", "b.u"), Connection("b.y", "c.u")))


SHORT = replace(MANOEUVRES["tipin15"], duration=0.2)


def ramp(t):
    return 1000.0 * t


def test_gauss_seidel_hands_on_within_the_step_and_jacobi_a_step_later(chain):
    results = run(chain, Experiment(0.01, inputs={"a.u": ramp}, scheme=Scheme.GAUSS_SEIDEL))
    for name in ("a.y", "b.y", "c.y"):
        np.testing.assert_array_equal(results[name][1:], results["a.u"][:-1])
    results = run(chain, Experiment(0.01, inputs={"a.u": ramp}, scheme=Scheme.JACOBI))
    for delay, name in enumerate(("a.y", "b.y", "c.y"), start=1):
        np.testing.assert_array_equal(results[name][delay:], results["a.u"][:-delay])


def test_inputs_of_every_type_may_be_constants_samples_or_functions_and_are_passed_on(relay):
    system = System({"a": relay}, ())
    samples = ramp(instants(0.01, 1e-3))
    for source in (ramp, samples):
        np.testing.assert_array_equal(run(system, Experiment(0.01, inputs={"a.u": source}))["a.u"], samples)
    np.testing.assert_array_equal(run(system, Experiment(0.01, inputs={"a.u": 3}))["a.u"], np.full(11, 3.0))
    with pytest.raises(WiringError, match=r"a\.u has \(10,\) samples; the run has 11 instants"):
        run(system, Experiment(0.01, inputs={"a.u": np.zeros(10)}))
    system = System({"a": relay, "b": relay}, (Connection("a.n_out", "b.n"), Connection("a.b_out", "b.b")))
    flags = np.arange(11) % 3 == 0
    inputs, parameters = {"a.n": np.arange(11), "a.b": flags}, {"b.count": 5, "b.flag": True}
    results = run(system, Experiment(0.01, inputs=inputs, parameters=parameters, scheme=Scheme.GAUSS_SEIDEL))
    np.testing.assert_array_equal(results["b.n_out"][1:], np.arange(10) + 5)
    np.testing.assert_array_equal(results["b.b_out"][1:], ~flags[:-1])
    assert results.dtype["b.n_out"] == np.int32
    assert results.dtype["b.b_out"] == np.bool_


def test_progress_counts_all_steps(native, monkeypatch):
    shown = []

    @contextmanager
    def progress(total, label):
        shown.append((total, label))
        yield shown.append

    monkeypatch.setattr("fmuloop.master.progress", progress)
    system = System({"can": native / "WheelSpeedCan.fmu"}, (), own=frozenset(["can"]))
    run(system, Experiment(0.01, label="a run"))
    assert (shown[0], shown[-1]) == ((10, "a run"), 10)


@pytest.mark.parametrize("name", ["SC_PHYS_PAGES", "SC_PAGE_SIZE"])
def test_memory_is_unlimited_where_the_machine_does_not_tell_it(name, monkeypatch):
    assert 1e8 < memory() < 1e14
    monkeypatch.setattr("os.sysconf_names", {name: 1})
    assert memory() == np.inf


def test_time_is_counted_in_whole_steps(relay):
    results = run(System({"a": relay}, ()), Experiment(2.0, step_size=1e-3))
    np.testing.assert_array_equal(results["time"], [k * 1e-3 for k in range(2001)])
    # what the FMU itself was told: t of the step plus its size
    np.testing.assert_array_equal(results["a.t"][1:], [k * 1e-3 + 1e-3 for k in range(2000)])
    assert instants(0.3, 0.1)[-1] == 3 * 0.1
    assert len(instants(1.0, 0.3)) == 4
    for step_size in (0.0, -1e-3, float("nan"), 2.0):
        with pytest.raises(WiringError, match="must be longer than 0 s"):
            instants(1.0, step_size)
    for duration, step_size in ((1.0, 1e-320), (1e300, 1e-3)):
        with pytest.raises(WiringError, match="too many steps"):
            instants(duration, step_size)


def test_the_loop_starts_consistently_unless_outputs_feed_back(built):
    start = simulate(MANOEUVRES["tipin15"], step_size=1.0, folder=built)[0]
    assert start["controller.T_ref"] == start["motor.T_mot"] == -12.0
    assert start["can.omega_2_can"] == pytest.approx(start["plant.omega_2"], rel=0.02)
    assert start["motor.omega_1_meas"] == pytest.approx(start["plant.omega_1"], abs=1.0)
    # omega_1_meas is a direct function of omega_1: fed back with its noise, it has no value.
    system = System({"motor": built / "MotorTorqueLoop.fmu"}, (Connection("motor.omega_1_meas", "motor.omega_1"),))
    with pytest.raises(SimulationError, match="algebraic loop"):
        run(system, Experiment(0.01, parameters={"motor.sigma_omega": 5.0}, scheme=Scheme.JACOBI))


@pytest.mark.parametrize("plant", PLANTS)
def test_runs_are_reproducible_and_seeds_matter(built, plant):
    first, second, other = (simulate(SHORT, plant, step_size=2e-3, seed=seed, folder=built) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, second)
    assert (first["motor.omega_1_meas"] != other["motor.omega_1_meas"]).any()


def test_stepping_by_hand_gives_the_same(built, tmp_path):
    """Motor and plant, one call of fmpy a variable, against the bound calls of the master."""
    files = {"motor": built / "MotorTorqueLoop.fmu", "plant": built / f"{PLANTS[0]}.fmu"}
    wires = (Connection("motor.T_mot", "plant.T_mot"), Connection("plant.omega_1", "motor.omega_1"))
    T_ref = np.where(np.arange(201) < 50, 0.0, 60.0)
    results = run(System(files, wires), Experiment(0.2, inputs={"motor.T_ref": T_ref}, parameters={"plant.v_0": 5.0}))
    with (
        opened(files["motor"], tmp_path / "motor") as motor,
        opened(files["plant"], tmp_path / "plant") as plant,
    ):
        plant.initialize(v_0=5.0)
        motor.initialize(T_ref=T_ref[0], omega_1=plant.get("omega_1"))
        for k in range(200):
            motor.step(k * 1e-3, 1e-3)
            plant.step(k * 1e-3, 1e-3)
            plant.set(T_mot=motor.get("T_mot"))
            motor.set(T_ref=T_ref[k + 1], omega_1=plant.get("omega_1"))
            for name, host in {"motor": motor, "plant": plant}.items():
                row = results[k + 1]
                assert {v: row[f"{name}.{v}"] for v in host.outputs()} == host.outputs()


def test_csv_gives_the_same_numbers_back(relay, tmp_path):
    inputs = {"a.u": lambda t: np.sqrt(t) / 3.0, "a.b": np.arange(11) % 2 == 0}
    results = run(System({"a": relay}, ()), Experiment(0.01, inputs=inputs))
    path = tmp_path / "new folder" / "results.csv"
    write_csv(results, path)
    read = read_csv(path)
    assert read.dtype.names == results.dtype.names
    for name in results.dtype.names or ():
        np.testing.assert_array_equal(read[name], results[name])
    assert [file.name for file in path.parent.iterdir()] == ["results.csv"]

"""What the schemes do in a step: from the declarations of the FMUs alone, nothing runs."""

import logging
import re
from typing import Any

import pytest
from fmutesting.foreign import tampered

from driveline.harness.loop.settings import loop
from fmuloop.errors import SimulationError, WiringError
from fmuloop.experiment import Experiment
from fmuloop.feedthrough import Feedthrough, declared
from fmuloop.interface import Interface
from fmuloop.loading import loaded
from fmuloop.runs import run
from fmuloop.schedule import Get, Move, Set, Step, Transfer, schedule, transfers
from fmuloop.system import Connection, Scheme, System
from fmuloop.wiring import fit


def planned(system, scheme=Scheme.PROPAGATED):
    fitted = fit(system)
    return schedule(scheme, fitted.system, fitted.interfaces)


def how(system):
    fitted = fit(system)
    return transfers(fitted.system, fitted.interfaces)


def test_every_output_is_read_once_with_the_inputs_of_its_instant_and_the_speed_after_the_plant(native):
    plan = planned(loop(folder=native.parent, build="native"))
    read = [f"{a.instance}.{name}" for a in (*plan.begin, *plan.end) if isinstance(a, Get) for name in a.outputs]
    interfaces = fit(loop(folder=native.parent, build="native")).interfaces
    assert sorted(read) == sorted(f"{i}.{v.name}" for i, f in interfaces.items() for v in f.of_causality("output"))
    # The motor passes omega_1 on within the instant: it is read again after the plant.
    end = planned(loop(folder=native.parent, build="native")).end
    after_plant = end[
        next(n for n, action in enumerate(end) if isinstance(action, Get) and action.instance == "plant") :
    ]
    assert after_plant[1:] == [Set("motor"), Get("motor", ["omega_1_meas"])]


def test_native_fmus_interpolate_torque_and_extrapolate_speed_and_others_hold_both(native, built):
    system = loop(folder=native.parent, build="native")
    assert how(system) == {"plant.T_mot": Transfer.INTERPOLATED, "motor.omega_1": Transfer.EXTRAPOLATED}
    begin = planned(system).begin
    assert begin.index(Step("motor")) < begin.index(Move("plant", ["T_mot"], Transfer.INTERPOLATED))
    assert how(loop(folder=built, build="python")) == dict.fromkeys(("plant.T_mot", "motor.omega_1"), Transfer.HELD)
    # T_ref is held by its nature, and the controller takes what it gets at its tick.
    assert not how(loop(folder=native.parent, build="native")).keys() & {"motor.T_ref", "controller.omega_1_meas"}


def test_a_loop_says_once_what_moves_and_what_is_held(built, caplog):
    caplog.set_level(logging.INFO, "fmuloop")
    with loaded(loop(folder=built, build="python")) as running:
        for _ in range(2):
            running.run(Experiment(0.01))
    (record,) = [r for r in caplog.records if r.levelno == logging.INFO]
    assert record.getMessage() == (
        "under the propagated scheme, over a step plant.T_mot is held, motor.omega_1 is held"
    )


@pytest.mark.parametrize(
    ("claim", "unable", "expected"),
    [
        (
            'canInterpolateInputs="true"',
            "plant",
            {"plant.T_mot": Transfer.HELD, "motor.omega_1": Transfer.EXTRAPOLATED},
        ),
        (
            'canInterpolateInputs="true"',
            "motor",
            {"plant.T_mot": Transfer.INTERPOLATED, "motor.omega_1": Transfer.HELD},
        ),
        (
            'maxOutputDerivativeOrder="1"',
            "plant",
            {"plant.T_mot": Transfer.INTERPOLATED, "motor.omega_1": Transfer.HELD},
        ),
    ],
)
def test_nothing_is_asked_of_an_fmu_that_it_does_not_claim(native, tmp_path, claim, unable, expected):
    file = loop(folder=native.parent, build="native").instances[unable]
    less = tampered(file, tmp_path / "less.fmu", lambda xml: re.sub(rf" {claim}", "", xml))
    places: dict[str, Any] = {unable: less}
    assert how(loop(folder=native.parent, build="native", **places)) == expected


def test_dependencies_are_read_as_declared_also_of_mapped_names(native, relay):
    assert declared(Interface(native / "MotorTorqueLoop.fmu")) == {
        "T_mot": frozenset(),
        "T_mot_est": frozenset(),
        "omega_1_meas": frozenset({"omega_1"}),
    }
    assert set(declared(Interface(relay)).values()) == {None}
    mapping = {"motor.measured": "omega_1_meas", "motor.speed": "omega_1"}
    fitted = fit(System({"motor": native / "MotorTorqueLoop.fmu"}, mapping=mapping))
    assert declared(fitted.interfaces["motor"])["measured"] == frozenset({"speed"})


def two_motors(folder):
    motor = folder / "MotorTorqueLoop.fmu"
    wires = (Connection("a.omega_1_meas", "b.omega_1"), Connection("b.omega_1_meas", "a.omega_1"))
    return System({"a": motor, "b": motor}, wires)


def test_an_algebraic_loop_is_named_before_anything_runs(native):
    message = "a.omega_1_meas follows from b.omega_1_meas follows from a.omega_1_meas within the same instant"
    with pytest.raises(WiringError, match=f"algebraic loop: {message}"):
        run(two_motors(native), Experiment(0.01))
    alone = System({"a": native / "MotorTorqueLoop.fmu"}, (Connection("a.omega_1_meas", "a.omega_1"),))
    with pytest.raises(WiringError, match=r"algebraic loop: a\.omega_1_meas follows from a\.omega_1_meas within"):
        run(alone, Experiment(0.01))


@pytest.mark.parametrize("scheme", [Scheme.GAUSS_SEIDEL, Scheme.JACOBI])
def test_the_other_schemes_break_an_algebraic_loop_if_it_settles_at_the_start(native, scheme):
    noiseless = {f"{name}.{p}": 0.0 for name in "ab" for p in ("sigma_omega", "q_omega")}
    results = run(two_motors(native), Experiment(0.01, parameters=noiseless, scheme=scheme))
    assert (results["a.omega_1_meas"] == 0.0).all()
    with pytest.raises(SimulationError, match="do not settle"):
        run(two_motors(native), Experiment(0.01, scheme=scheme, parameters={"a.q_omega": 0.0, "b.q_omega": 0.0}))


def test_what_is_not_declared_makes_no_algebraic_loop_and_is_passed_on_within_the_instant(relay):
    # PythonFMU declares nothing: everything may follow from everything.
    system = System({"a": relay, "b": relay}, (Connection("a.y", "b.u"), Connection("b.y", "a.u")))
    assert (run(system, Experiment(0.01))["b.y"] == 0.0).all()
    fitted = fit(system)
    feedthrough = Feedthrough(fitted.system, fitted.interfaces)
    assert [name for outputs in feedthrough.propagation(set()) for name in outputs] == [
        *("a.y", "a.t", "a.n_out", "a.b_out"), *("b.y", "b.t", "b.n_out", "b.b_out")
    ]  # fmt: skip
    fitted = fit(System({"b": relay, "a": relay}, (Connection("a.y", "b.u"),)))
    order = Feedthrough(fitted.system, fitted.interfaces).propagation(set())
    assert [outputs[0].partition(".")[0] for outputs in order] == ["a", "b"]


def test_a_scheme_may_be_given_by_its_name_and_none_is_taken_for_another(native):
    system, duration = System({"motor": native / "MotorTorqueLoop.fmu"}, own=frozenset({"motor"})), 0.01
    for scheme in Scheme:
        named = run(system, Experiment(duration, scheme=scheme.value))  # pyright: ignore[reportArgumentType]
        assert named.tobytes() == run(system, Experiment(duration, scheme=scheme)).tobytes()
    for other in ("gaus-seidel", None):
        with pytest.raises(WiringError, match=r"unknown scheme .*gauss-seidel"):
            run(system, Experiment(duration, scheme=other))  # pyright: ignore[reportArgumentType]

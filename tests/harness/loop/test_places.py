"""Every block of the loop can be another one; what it need not have, it may lack."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from fmutesting.foreign import RELAY, build_relay, tampered

from driveline.fmus.catalogue import EVERY
from driveline.harness.loop.mapped_names import mappings, require_known
from driveline.harness.loop.places import CONNECTIONS, NO_DAMPING, OFFERED, OPTIONAL, PLACES, PLANTS
from driveline.harness.loop.settings import Settings, chosen_build, loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import signals, simulate, start
from fmuloop.errors import WiringError
from fmuloop.experiment import Experiment
from fmuloop.interface import Interface
from fmuloop.limits import USUAL_LIMITS
from fmuloop.runs import run
from fmuloop.wiring import fit

SHORT = replace(MANOEUVRES["tipin15"], duration=1.2)

FEEDTHROUGH = {"controller.T_driver": "u", "controller.T_ref": "y", "controller.omega_1_meas": "w"}
"""A relay with a second input in the place of the controller."""


@pytest.fixture(scope="module")
def relay(tmp_path_factory):
    """Passes u on, and has an input w that it does not use."""
    folder = tmp_path_factory.mktemp("relay")
    script = folder / "relay.py"
    text = RELAY.read_text().replace('{"u": Real,', '{"u": Real, "w": Real,')
    script.write_text(text.replace("self.flag = False", "self.flag, self.w = False, 0.0"))
    return build_relay(folder, script)


@pytest.fixture(scope="module")
def usual(native):
    return simulate(SHORT, folder=native.parent)


@pytest.mark.parametrize("place", PLACES)
def test_a_file_takes_the_place_of_a_block(native, usual, tmp_path, place):
    ours = native / f"{PLACES[place][0]}.fmu"
    theirs = tampered(ours, tmp_path / "theirs.fmu", lambda xml: xml + "\n")
    block: dict[str, Any] = {place: theirs}
    assert loop(folder=native.parent, **block).instances[place] == theirs
    np.testing.assert_array_equal(simulate(SHORT, folder=native.parent, **block), usual)


@pytest.mark.parametrize(
    ("place", "name", "hint"),
    [
        ("plant", "ValidationVehicel", "did you mean ValidationVehicle"),
        ("controller", "DampingControler", "did you mean DampingController"),
        ("motor", "Motor", "known are: MotorTorqueLoop"),
        ("can", "TwoMassDriveline", "known are: WheelSpeedCan"),
        *((place, "", r"\(an empty name\)") for place in PLACES),
    ],
)
def test_an_unknown_block_is_answered_with_those_of_its_place(place, name, hint):
    block: dict[str, Any] = {place: name}
    for function in (loop, chosen_build):
        with pytest.raises(WiringError, match=rf"unknown {place} {f'{name}; {hint}' if name else hint}.*\.fmu"):
            function(**block)


def test_our_fmus_have_all_that_is_optional_and_take_their_inputs_from_the_loop(native):
    system = loop(folder=native.parent)
    interfaces = {name: Interface(path) for name, path in system.instances.items()}
    for name in OPTIONAL:
        instance, _, variable = name.partition(".")
        assert variable in interfaces[instance].variables
    assert len(fit(system).system.connections) == len(CONNECTIONS), "our bus tells no more"
    fed = {connection.target for connection in (*CONNECTIONS, *OFFERED)} | {port.name for port in system.inputs}
    have = {f"{name}.{v.name}" for name, interface in interfaces.items() for v in interface.of_causality("input")}
    assert have - fed == {"plant.T_load_rec"}


def test_a_controller_need_not_use_every_signal(both_built, relay, caplog):
    results = simulate(SHORT, folder=both_built, controller=relay, mapping=FEEDTHROUGH)
    np.testing.assert_array_equal(results["controller.T_ref"][1:], results["controller.T_driver"][:-1])
    assert "controller.enable" not in (results.dtype.names or ())
    assert results["plant.T_gear"][-1] > 50.0
    (noted,) = (text for text in caplog.messages if "the loop runs without" in text)
    lacking = ", ".join(name for name in OPTIONAL if name.startswith("controller."))
    assert noted == f"Relay.fmu: the loop runs without {lacking}"


def test_without_damping_none_stands_in_the_place_of_a_controller_that_is_always_on(native, native_builder, relay):
    folder = native_builder(EVERY[NO_DAMPING], native.parent).parent.parent
    given = {"folder": folder, "build": "native", "seed": 3}
    theirs = {"controller": relay, "mapping": FEEDTHROUGH, "parameters": {"controller.gain": 2.0}}
    off = simulate(SHORT, **given, **theirs, control=False)
    np.testing.assert_array_equal(off, simulate(SHORT, **given, controller=NO_DAMPING, control=False))
    system = loop(PLANTS[0], **given, controller=relay, mapping=FEEDTHROUGH)
    at_times = {**signals(SHORT), "controller.enable": lambda t: t < 0.5}
    with pytest.raises(WiringError, match=r"controller\.enable: Relay\.fmu does not have it and .* always 1"):
        run(system, Experiment(SHORT.duration, inputs=at_times, parameters=start(SHORT)))


def test_what_is_not_optional_must_be_there_and_a_seed_need_not(built, relay, both_built, tmp_path):
    with pytest.raises(WiringError) as error:
        simulate(SHORT, folder=built, controller=relay, mapping={"controller.T_ref": "y"})
    assert [line.partition(":")[0] for line in str(error.value).splitlines()] == [
        "controller.T_driver", "controller.omega_1_meas"
    ]  # fmt: skip
    plain = tampered(
        both_built / "MotorTorqueLoop.fmu", tmp_path / "plain.fmu", lambda xml: xml.replace("seed", "grain")
    )
    results = simulate(SHORT, folder=both_built, motor=plain, seed=7)
    assert results["motor.T_mot"][-1] > 50.0
    with pytest.raises(WiringError, match="no parameter sed; did you mean seed"):
        simulate(SHORT, folder=both_built, motor=both_built / "MotorTorqueLoop.fmu", parameters={"motor.sed": 1})


def test_a_table_named_as_the_file_of_an_fmu_is_for_it_alone() -> None:
    given = {"mine.T_ref": "cmd", "other.T_ref": "out", "can.valid": "ok"}
    files = ["x/mine.fmu", "other.fmu", "DampingController"]
    found = mappings(given, ["TwoMassDriveline"], files, USUAL_LIMITS)
    made = {key[1]: Settings(*key, mapping=each).mapping for key, each in found.items()}
    assert made == {
        "x/mine.fmu": {"can.valid": "ok", "controller.T_ref": "cmd"},
        "other.fmu": {"can.valid": "ok", "controller.T_ref": "out"},
        "DampingController": {"can.valid": "ok"},
    }
    both = Settings(controller=files[0], mapping={"controller.T_ref": "a", **given}).mapping
    assert both == {**made[files[0]], "other.T_ref": "out"}
    assert Settings("plant.fmu", "other/plant.fmu", mapping={"plant.v": "v"}).mapping == {"plant.v": "v"}
    dotted = Settings("x/car_v1.2.fmu", mapping={"car_v1.2.T_gear": "tau", "car_v1.2.v": "speed"}).mapping
    assert dotted == {"plant.T_gear": "tau", "plant.v": "speed"}
    with pytest.raises(WiringError, match=r"^--map mine: controller and plant are both mine\.fmu; rename one, or name"):
        Settings("mine.fmu", "x/mine.fmu", mapping=given)
    with pytest.raises(WiringError, match=r"^other is no place of the loop, nor the name of an FMU in it; did you"):
        require_known(both)

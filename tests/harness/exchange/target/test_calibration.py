"""The A2L description: what a calibration tool reads and writes by it is what the controller works with."""

import struct
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from driveline.fmus.catalogue import CONTROLLERS
from driveline.harness.commands.cli import main
from driveline.harness.exchange.target.controllers import Programs
from driveline.models import motor_torque_loop, two_mass_driveline, wheel_speed_can
from driveline.models.controller import T_S
from driveline.models.damping_controller import BLOCK
from fmublocks.block.runner import runner
from fmublocks.description.variables import interface
from fmublocks.target.image import a2l_description, symbols
from fmublocks.target.link import Link
from fmublocks.target.remote import Remote

FMU = CONTROLLERS["DampingController"]
MOTOR, CAN, PLANT = motor_torque_loop.BLOCK, wheel_speed_can.BLOCK, two_mass_driveline.BLOCK


@pytest.fixture(scope="module")
def module(target: Programs) -> Any:
    """What a public parser makes of the file."""
    pya2l = pytest.importorskip("pya2l.parser", reason="pya2l is not installed")
    with pya2l.A2lParser() as parser:
        (found,) = parser.tree_from_a2l(a2l_description(FMU, target.image).encode()).PROJECT.MODULE
        return found


def test_everything_that_is_declared_is_described_with_unit_limits_and_meaning(module: Any) -> None:
    units = {method.Name.Value: method.Unit.Value for method in module.COMPU_METHOD}
    described = {item.Name.Value: item for item in (*module.CHARACTERISTIC, *module.MEASUREMENT)}
    assert described.keys() == {variable.name for variable in interface(BLOCK)}
    for variable in interface(BLOCK):
        item = described[variable.name]
        assert item.LongIdentifier.Value == variable.declaration.description
        assert units.get(item.Conversion.Value, "") == variable.unit
        if variable.causality == "parameter":
            assert (item.LowerLimit.Value, item.UpperLimit.Value) == pytest.approx(variable.bounds())
    assert {item.Name.Value for item in module.CHARACTERISTIC} == set(BLOCK.Parameters._fields)


def test_the_words_of_the_status_are_those_of_the_declaration(module: Any) -> None:
    status, cause = module.COMPU_VTAB
    causes = (
        "none speed_range speed_jump speed_frozen torque_implausible wheel_contradicts wrong_direction wrong_launch"
        " feeds_oscillation frame_late"
    )
    assert [pair.OutVal.Value for pair in cause.InValOutVal] == causes.split()
    statuses = "off damping_with_wheel_speed damping_without_wheel_speed fallback"
    assert [pair.OutVal.Value for pair in status.InValOutVal] == statuses.split()


def addresses(module: Any) -> Mapping[str, int]:
    parameters = {item.Name.Value: item.Address.Value for item in module.CHARACTERISTIC}
    return parameters | {item.Name.Value: item.ECU_ADDRESS.Address.Value for item in module.MEASUREMENT}


def number(link: Link, address: int) -> float:
    return struct.unpack("<f", link.read(address, 4))[0]


def test_at_the_addresses_are_the_values(module: Any, target: Programs) -> None:
    at, p = addresses(module), BLOCK.Parameters()
    u = BLOCK.Input(T_driver=12.5, omega_1_meas=150.0, T_mot_est=12.5, omega_2_can=149.0, valid=True, counter=3)
    with target.target() as link:
        for name, value in p._asdict().items():
            assert number(link, at[name]) == pytest.approx(value, rel=1e-7), name
        outputs = link.start(u).outputs
        assert [number(link, at[name]) for name in BLOCK.Input._fields] == [float(value) for value in u]
        assert [number(link, at[name]) for name in BLOCK.Output._fields] == list(outputs)
    assert symbols(target.image)["calibration"] == at["J_1"]


def simulated(remote: Remote, p: Any, once_started: Callable[[], object] = lambda: None) -> list[float]:
    """T_ref in a loop of the blocks that goes through a tip-in, with the controller on the target."""
    plant = runner(PLANT, PLANT.Input(), PLANT.Parameters(v_0=15.0 / 3.6))
    motor = runner(MOTOR, MOTOR.Input(omega_1=plant.output(PLANT.Input()).omega_1), MOTOR.Parameters())
    can = runner(CAN, CAN.Input(), CAN.Parameters())
    block, x, found = remote.block, None, []
    for k in range(250):
        y = plant.output(PLANT.Input())
        measured = motor.output(MOTOR.Input(omega_1=y.omega_1))
        wheels = CAN.Input(omega_wheel_L=y.omega_wheel_L, omega_wheel_R=y.omega_wheel_R)
        received = can.output(wheels)
        u = BLOCK.Input(
            T_driver=80.0 if k > 50 else 5.0,
            omega_1_meas=measured.omega_1_meas,
            T_mot_est=measured.T_mot_est,
            omega_2_can=received.omega_2_can,
            valid=received.valid,
            counter=received.counter,
        )
        if x is None:
            x = block.start(u, p)
            once_started()
        found.append(block.output(x, u, p).T_ref)
        x = block.update(x, u, p)
        motor.advance(MOTOR.Input(T_ref=found[-1], omega_1=y.omega_1), T_S)
        plant.advance(PLANT.Input(T_mot=measured.T_mot), T_S)
        can.advance(wheels, T_S)
    return found


def test_a_value_that_is_changed_by_its_address_acts_in_the_loop_as_one_that_is_set(module, target) -> None:
    p, address = BLOCK.Parameters(), addresses(module)["k_d"]
    remotes = [Remote(BLOCK, target.image) for _ in range(3)]

    def changed() -> None:
        link = remotes[2]._link
        assert link
        link.write(address, struct.pack("<f", 0.75))

    try:
        usual, was_set = simulated(remotes[0], p), simulated(remotes[1], p._replace(k_d=0.75))
        was_changed = simulated(remotes[2], p, changed)
    finally:
        for remote in remotes:
            remote.close()
    assert was_changed == was_set
    assert max(abs(a - b) for a, b in zip(usual, was_set, strict=True)) > 1.0


def test_the_command_writes_image_and_description(target: Programs, tmp_path: Path) -> None:
    assert main(["target", "image", "--output", str(tmp_path), "--quiet"]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["controller.a2l", "controller.elf"]
    assert (tmp_path / "controller.a2l").read_text(encoding="utf-8") == a2l_description(FMU, target.image)

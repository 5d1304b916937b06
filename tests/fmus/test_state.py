"""A saved state restores everything: the run that follows is the same, bit by bit."""

import math
import re

from fmutesting.host import opened
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS

every_fmu = together("name", FMUS)


def drive(host, first, last):
    """Runs communication steps of 1.3 ms with inputs that move; all outputs of every step."""
    reals = [n for n in host.names("input") if host.variables[n].type == "Real" and n != "slope"]
    seen = []
    for k in range(first, last):
        host.set(**{n: 30.0 + 25.0 * math.sin(0.05 * k + j) for j, n in enumerate(reals)})
        host.step(k * 0.0013, 0.0013)
        seen.append(host.outputs())
    return seen


@every_fmu
def test_a_run_goes_on_bit_by_bit_after_set_and_after_deserialise(built, tmp_path, name):
    with opened(built / f"{name}.fmu", tmp_path) as host:
        changed = host.names("parameter")[0]
        host.initialize(**{changed: host.get(changed) * 1.01})
        drive(host, 0, 30)
        state = host.fmu.getFMUstate()
        saved = host.fmu.serializeFMUstate(state)
        expected = drive(host, 30, 60)
        host.fmu.setFMUstate(state)
        assert drive(host, 30, 60) == expected
        host.fmu.setFMUstate(state)
        host.fmu.freeFMUstate(state)
        assert drive(host, 30, 60) == expected

        host.fmu.reset()
        restored = host.fmu.deSerializeFMUstate(saved)
        host.fmu.setFMUstate(restored)
        host.fmu.freeFMUstate(restored)
        assert drive(host, 30, 60) == expected


@every_fmu
def test_a_state_moves_to_another_instance_and_has_one_serialised_form(built, tmp_path, name):
    with opened(built / f"{name}.fmu", tmp_path, "a") as a, opened(built / f"{name}.fmu", tmp_path, "b") as b:
        a.initialize()
        drive(a, 0, 10)
        saved = a.fmu.serializeFMUstate(a.fmu.getFMUstate())
        b.fmu.setFMUstate(b.fmu.deSerializeFMUstate(saved))
        assert b.fmu.serializeFMUstate(b.fmu.getFMUstate()) == saved
        assert drive(b, 10, 20) == drive(a, 10, 20)


def test_a_state_saved_before_initialization_restores_that_mode(motor):
    motor.set(T_ref=40.0, tau=0.01)
    state = motor.fmu.getFMUstate()
    motor.initialize(T_ref=10.0)
    motor.step(0.0, 0.01)
    motor.fmu.setFMUstate(state)
    assert (motor.get("T_ref"), motor.get("T_mot")) == (40.0, 40.0)
    motor.initialize(tau=0.02)


def serialized(host):
    return bytes(host.fmu.serializeFMUstate(host.fmu.getFMUstate()))


def restore(host, saved):
    host.fmu.setFMUstate(host.fmu.deSerializeFMUstate(saved))


def with_a_wrong_bit(place):
    return lambda saved: saved[:place] + bytes([saved[place] ^ 1]) + saved[place:][1:]


@together(
    "damage",
    [
        *map(with_a_wrong_bit, (0, 9, 100, -20)),
        lambda saved: saved[:-1],
        lambda saved: saved[:3],
        lambda saved: saved * 2,
    ],
)
def test_a_damaged_state_is_refused_and_changes_nothing(built, tmp_path, damage):
    with opened(built / "MotorTorqueLoop.fmu", tmp_path) as host:
        host.initialize(T_ref=40.0)
        host.step(0.0, 0.01)
        before = host.outputs()
        message = host.refuses(restore, host, damage(serialized(host)))
        assert message == "the FMU state is refused: its bytes are damaged"
        assert host.outputs() == before
        host.step(0.01, 0.01)


def test_a_state_of_another_fmu_is_refused_and_both_are_named(built, tmp_path):
    with (
        opened(built / "MotorTorqueLoop.fmu", tmp_path / "motor") as motor,
        opened(built / "WheelSpeedCan.fmu", tmp_path / "can") as can,
    ):
        sentence = r"the FMU state is refused: it was saved by (\S+), this is (\S+)"
        to_motor, to_can = (
            re.fullmatch(sentence, to.refuses(restore, to, serialized(of))) for to, of in ((motor, can), (can, motor))
        )
        assert to_motor
        assert to_can
        assert to_motor.groups() == to_can.groups()[::-1]
        assert to_motor[1] != to_motor[2]

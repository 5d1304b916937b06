"""A step that cannot be followed, or not to finite outputs, is refused by name in both builds, and changes nothing."""

import sys
from typing import Annotated, NamedTuple

import pytest
from fmutesting.host import opened
from fmutesting.together import together
from pythonfmu import Fmi2Slave

from fmublocks.block.declaration import Real
from fmublocks.block.operators import where
from fmublocks.block.types import ContinuousBlock
from fmublocks.fmu import Fmu
from fmublocks.python.refusal import Refused
from fmublocks.python.slave import FMI_DISCARD, BlockSlave


class Input(NamedTuple):
    pull: Annotated[float, Real("1/s", "pull to zero from either side")] = 0.0


class Parameters(NamedTuple):
    pass


class State(NamedTuple):
    x: Annotated[float, Real("1", "distance")]
    n: Annotated[float, Real("1", "time")]


class Output(NamedTuple):
    y: Annotated[float, Real("1", "an output that overflows when the distance is above 1.1")]


BLOCK = ContinuousBlock(
    name="Pulled",
    description="A state that is pulled to zero and cannot stay there, or pushed away without bound",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=Output,
    start=lambda u, p: State(1.0, 0.0),
    output=lambda x, u, p: Output(x.x * (sys.float_info.max / 1.1)),
    derivative=lambda x, u, p: State(where(x.x > 0.0, -u.pull, u.pull), 1.0),
    event_indicators=lambda x, u, p: (x.x,),
    step_size=0.01,
)


class PulledSlave(BlockSlave, Fmi2Slave):  # pyright: ignore[reportIncompatibleMethodOverride]
    """As the Python build runs it."""

    block = BLOCK


def refusal_in_python(pull: float) -> str:
    slave = PulledSlave(instance_name="pulled", resources="")
    slave.setup_experiment(0.0, None, None)
    slave.enter_initialization_mode()
    slave.exit_initialization_mode()
    slave.do_step(0.0, 0.25)
    slave.set_real([0], [pull])
    before = slave.get_real([0, 1]), slave._get_fmu_state()
    with pytest.raises(Refused) as refusal:
        slave.do_step(0.25, 2.0)
    assert (slave.get_real([0, 1]), slave._get_fmu_state()) == before
    slave.set_real([0], [0.0])
    slave.do_step(0.25, 2.0)
    return str(refusal.value)


def refusal_in_c(path, folder, pull: float) -> str:
    with opened(path, folder) as host:
        host.initialize()
        host.step(0.0, 0.25)
        host.set(pull=pull)
        before = host.outputs()
        message = host.refuses(host.step, 0.25, 2.0)
        assert host.outputs() == before
        host.set(pull=0.0)
        host.step(0.25, 2.0)
    return message


@together(
    "pull, message",
    [
        (1.0, "the step of 2.0 s is refused; x changes too fast to be followed with these parameters and inputs"),
        (-1.0, "the step of 2.0 s is refused; y would be inf"),
    ],
)
def test_a_step_to_nowhere_is_refused(native_builder, tmp_path, pull, message):
    path = native_builder(Fmu(BLOCK, stop_time=1.0), tmp_path)
    assert refusal_in_c(path, tmp_path / "unpacked", pull) == message
    assert refusal_in_python(pull) == message


@pytest.fixture
def little_work(monkeypatch):
    """Of integration, in both builds: a stretch is an explicit step."""
    monkeypatch.setattr("fmublocks.block.integrator.MOST_WORK", 49)


TOO_LONG = "the step of 0.51 s is refused; n changes so fast that it would take too long; shorter steps are allowed"


def test_a_step_that_takes_too_long_is_discarded_in_c(little_work, native_builder, tmp_path):
    """50 stretches can be made, 51 not; what the longer step has changed is undone."""
    path = native_builder(Fmu(BLOCK, stop_time=1.0), tmp_path)
    with opened(path, tmp_path / "unpacked") as host:
        host.initialize()
        before = host.outputs()
        assert (host.refuses(host.step, 0.0, 0.51), host.status) == (TOO_LONG, FMI_DISCARD)
        assert host.outputs() == before
        host.step(0.0, 0.5)


def test_a_step_that_takes_too_long_is_discarded_in_python(little_work):
    slave, logged = PulledSlave(instance_name="pulled", resources=""), []
    slave.setup_experiment(0.0, None, None)
    slave.enter_initialization_mode()
    slave.exit_initialization_mode()
    before = slave._get_fmu_state()
    slave.log = lambda message, status, category: logged.append((message, status))
    assert not slave.do_step(0.0, 0.51)
    assert logged == [(TOO_LONG, FMI_DISCARD)]
    assert slave._get_fmu_state() == before
    assert slave.do_step(0.0, 0.5)

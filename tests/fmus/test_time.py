"""The sequence of a run: initialization, communication steps of any length, time."""

import math
import sys
from itertools import cycle, repeat
from typing import Annotated, NamedTuple

import pytest
from pythonfmu import Fmi2Slave

from driveline.fmus.catalogue import FMUS
from driveline.fmus.python.slave import BlockSlave
from driveline.models.block.declaration import Real
from driveline.models.block.types import SampledBlock
from tests.fmus.host import opened
from tests.together import together

SAMPLED = [name for name, fmu in FMUS.items() if isinstance(fmu.block, SampledBlock)]
T_S = 0.002

COMMUNICATION_STEPS = {
    "0.1 ms": (0.0001,),
    "0.5 ms": (0.0005,),
    "1 ms": (0.001,),
    "2 ms": (0.002,),
    "3.3 ms": (0.0033,),
    "10 ms": (0.01,),
    "mixed": (0.0001, 0.01, 0.0033, 0.0005, 0.002, 0.001),
}


def steps_to(end, start, sizes):
    """Communication points and step sizes from start to end, the last step shortened to end there."""
    time = start
    for size in sizes:
        if end - time < 1e-9:
            return
        step_size = min(size, end - time)
        yield time, step_size
        time += step_size


class Number(NamedTuple):
    n: Annotated[float, Real("1", "a number")] = 0.0


class Nothing(NamedTuple):
    pass


class CounterSlave(BlockSlave, Fmi2Slave):  # pyright: ignore[reportIncompatibleMethodOverride]
    """Adds its input once every tick."""

    block = SampledBlock(
        name="Counter",
        description="Sum over the ticks",
        module=__name__,
        Parameters=Nothing,
        Input=Number,
        State=Number,
        Output=Number,
        start=lambda u, p: Number(0.0),
        output=lambda x, u, p: x,
        update=lambda x, u, p: Number(x.n + u.n),
        sample_time=T_S,
    )


@pytest.fixture
def counter():
    slave = CounterSlave(instance_name="counter", resources="")
    slave.setup_experiment(0.0, None, None)
    slave.enter_initialization_mode()
    slave.exit_initialization_mode()
    slave.set_real([0], [1.0])
    return slave


def test_a_tick_takes_the_inputs_of_the_step_that_begins_there_and_shows_one_sample_later(counter):
    counter.do_step(0.0, 0.001)
    assert counter.get_real([1]) == [0.0]
    counter.set_real([0], [10.0])
    counter.do_step(0.001, 0.001)
    assert counter.get_real([1]) == [1.0]
    counter.do_step(0.002, 0.0001)
    assert counter.get_real([1]) == [1.0]
    counter.do_step(0.0021, 0.0019)
    assert counter.get_real([1]) == [11.0]


def test_a_long_step_makes_all_ticks_in_it_with_the_inputs_held(counter):
    counter.do_step(0.0, 0.0033)
    assert counter.get_real([1]) == [1.0]
    counter.do_step(0.0033, 0.0107)
    assert counter.get_real([1]) == [7.0]


@pytest.mark.parametrize("step_size", [0.001, 0.0033, 0.002 / 3.0, 0.1])
def test_a_host_that_adds_up_its_time_gets_every_tick_once(counter, step_size):
    time = 0.0
    for k in range(1, 20_001):
        counter.do_step(time, step_size)
        time += step_size
        assert counter.get_real([1]) == [math.floor(k * step_size / T_S + 1e-3)]


@pytest.mark.parametrize("off", [0.9e-6, -0.9e-6])
def test_the_clock_of_a_host_may_go_wrong_and_no_tick_moves(counter, off):
    """A sum of 1e7 steps of 1 ms is 2 us off; here it is so after three steps, and 0.2 ms after 200."""
    time = 0.0
    for k in range(200):
        counter.set_real([0], [float(k)])
        counter.do_step(time, 0.001)
        time = counter.time + off
        assert counter.get_real([1]) == [sum(range(0, k, 2))]


@together("name", SAMPLED)
@together("sizes", COMMUNICATION_STEPS.values())
def test_a_sampled_block_does_not_depend_on_the_communication_step(built, tmp_path, name, sizes):
    block = FMUS[name].block
    assert isinstance(block, SampledBlock)
    inputs = [n for n in block.Input._fields if isinstance(block.Input()._asdict()[n], float)]
    u, p = block.Input(), block.Parameters()
    with opened(built / f"{name}.fmu", tmp_path) as host:
        host.initialize()
        x = block.start(u, p)
        for segment in range(4):
            u = u._replace(**{n: 20.0 + 7.0 * segment + k for k, n in enumerate(inputs)})
            host.set(**{n: getattr(u, n) for n in inputs})
            for time, step_size in steps_to(0.03 * (segment + 1), 0.03 * segment, cycle(sizes)):
                host.step(time, step_size)
            for _ in range(round(0.03 / block.sample_time)):
                x = block.update(x, u, p)
            assert tuple(host.outputs().values()) == tuple(block.output(x, u, p))


@together("name", FMUS)
def test_outputs_are_right_at_the_start_and_parameters_in_effect(built, tmp_path, name):
    block = FMUS[name].block
    u, p = block.Input(), block.Parameters()
    change = {n: value for n, value in (("v_0", 10.0), ("T_0", 40.0), ("o_T", 2.0), ("i", 8.0)) if hasattr(p, n)}
    first = block.Input._fields[0]
    with opened(built / f"{name}.fmu", tmp_path) as host:
        host.set(**change)
        host.fmu.setupExperiment(startTime=3.0)
        host.fmu.enterInitializationMode()
        host.set(**{first: 30.0})
        u, p = u._replace(**{first: 30.0}), p._replace(**change)
        expected = tuple(block.output(block.start(u, p), u, p))
        assert tuple(host.outputs().values()) == expected
        host.fmu.exitInitializationMode()
        assert tuple(host.outputs().values()) == expected


def test_an_input_that_is_fed_through_shows_before_the_step(built, tmp_path):
    with opened(built / "MotorTorqueLoop.fmu", tmp_path) as host:
        host.initialize(sigma_omega=0.0, q_omega=0.0)
        host.set(omega_1=123.0)
        assert host.get("omega_1_meas") == 123.0


def test_time_counts_from_the_start_time(built, tmp_path):
    block = FMUS["WheelSpeedCan"].block
    assert isinstance(block, SampledBlock)
    with opened(built / "WheelSpeedCan.fmu", tmp_path) as host:
        host.initialize(start_time=5.0, omega_wheel_L=20.0, omega_wheel_R=20.0)
        u, p = block.Input(20.0, 20.0), block.Parameters()
        x = block.start(u, p)
        for time, step_size in steps_to(5.1, 5.0, repeat(0.01)):
            host.step(time, step_size)
        for _ in range(100):
            x = block.update(x, u, p)
        assert tuple(host.outputs().values()) == tuple(block.output(x, u, p))


@together("samples, shown, made", [(0.9989, 0, 1), (0.9991, 1, 1), (1.0009, 1, 1), (1.0011, 1, 2)])
def test_a_tick_within_a_thousandth_of_a_sample_is_at_the_end_of_the_step(built, tmp_path, samples, shown, made):
    """After a step of so many samples: ticks whose result shows, ticks that took the inputs of that step."""
    block = FMUS["DampingController"].block
    assert isinstance(block, SampledBlock)
    first, then = (block.Input(T_driver=torque) for torque in (20.0, 60.0))
    p = block.Parameters()
    states = [block.start(block.Input(), p)]
    for k in range(2):
        states.append(block.update(states[k], first if k < made else then, p))
    with opened(built / "DampingController.fmu", tmp_path) as host:
        host.initialize()
        host.set(T_driver=first.T_driver)
        host.step(0.0, samples * T_S)
        assert tuple(host.outputs().values()) == tuple(block.output(states[shown], first, p))
        host.set(T_driver=then.T_driver)
        host.step(samples * T_S, (2.0 - samples) * T_S)
        assert tuple(host.outputs().values()) == tuple(block.output(states[2], then, p))


@together("step_size", [0.0, -0.001, math.nextafter(1000.0, math.inf), 1e300, math.nan, math.inf])
def test_a_step_that_is_not_positive_or_too_long_is_refused(built, tmp_path, step_size):
    with opened(built / "MotorTorqueLoop.fmu", tmp_path) as host:
        host.initialize(T_ref=50.0)
        before = host.outputs()
        message = host.refuses(host.step, 0.0, step_size)
        assert message == f"communicationStepSize = {step_size!r} s is refused; allowed is above 0 to 1000 s"
        assert host.outputs() == before
        host.step(0.0, 0.001)


@together("step_size", [5e-324, 1000.0])
def test_the_shortest_and_the_longest_step_are_allowed(built, tmp_path, step_size):
    """Shown by a step that is refused for its time, which is looked at after its size."""
    with opened(built / "MotorTorqueLoop.fmu", tmp_path) as host:
        host.initialize()
        assert "currentCommunicationPoint = 7.0 s" in host.refuses(host.step, 7.0, step_size)


def test_a_step_that_does_not_move_time_is_refused(built, tmp_path):
    """Else a sampled block would stand still while all its steps are answered with OK."""
    with opened(built / "WheelSpeedCan.fmu", tmp_path) as host:
        host.initialize(start_time=1e17)
        message = "communicationStepSize = 0.001 s is refused; added to the time 1e+17 s it leaves it as it is"
        assert host.refuses(host.step, 1e17, 0.001) == message
        host.fmu.reset()
        host.initialize(start_time=1.0)
        host.step(1.0, math.ulp(1.0))


@together("time", [0.0, 0.0011, 0.001 - 1.01e-6, 0.001 + 1.01e-6, math.nan])
def test_a_step_from_another_time_is_refused(built, tmp_path, time):
    with opened(built / "WheelSpeedCan.fmu", tmp_path) as host:
        host.initialize()
        host.step(0.0, 0.001)
        message = host.refuses(host.step, time, 0.001)
        reached = "WheelSpeedCan has been computed up to 0.001 s"
        assert message == f"currentCommunicationPoint = {time!r} s is refused; {reached}"
        host.step(0.001, 0.001)


@together("difference", [-0.99e-6, 0.99e-6])
def test_the_time_of_a_host_may_be_a_microsecond_off(built, tmp_path, difference):
    with opened(built / "WheelSpeedCan.fmu", tmp_path) as host:
        host.initialize()
        host.step(0.0, 0.001)
        host.step(0.001 + difference, 0.001)
        assert f"computed up to {0.001 + difference + 0.001!r} s" in host.refuses(host.step, 0.0, 0.001)
        host.fmu.reset()
        host.initialize()
        host.step(1e-6, 0.001)


def test_any_finite_time_is_a_start_time(built, tmp_path):
    with opened(built / "WheelSpeedCan.fmu", tmp_path) as host:
        for time in (sys.float_info.max, -sys.float_info.max, 5.0):
            host.initialize(start_time=time)
            host.fmu.reset()


def test_a_run_ends_at_its_stop_time(built, tmp_path):
    with opened(built / "WheelSpeedCan.fmu", tmp_path) as host:
        host.initialize(start_time=1.0, stop_time=1.01)
        host.step(1.0, 0.009)
        before = host.outputs()
        message = host.refuses(host.step, 1.009, 0.001 + 1.01e-6)
        assert message == f"a step to {1.009 + (0.001 + 1.01e-6)!r} s is refused; the run was said to stop at 1.01 s"
        assert host.outputs() == before
        host.step(1.009, 0.001 + 0.99e-6)
        assert "stop at 1.01 s" in host.refuses(host.step, 1.01, 0.001)


def test_the_stop_time_is_kept_in_a_saved_state_and_forgotten_by_a_reset(built, tmp_path):
    with opened(built / "WheelSpeedCan.fmu", tmp_path) as host:
        host.initialize(stop_time=0.01)
        saved = host.fmu.serializeFMUstate(host.fmu.getFMUstate())
        host.fmu.reset()
        host.initialize()
        host.step(0.0, 0.02)
        host.fmu.setFMUstate(host.fmu.deSerializeFMUstate(saved))
        assert "stop at 0.01 s" in host.refuses(host.step, 0.0, 0.02)


@together("stop_time", [math.nextafter(5.0, 0.0), -math.inf, math.nan])
def test_a_run_does_not_stop_before_its_start(built, tmp_path, stop_time):
    with opened(built / "WheelSpeedCan.fmu", tmp_path) as host:
        message = host.refuses(host.initialize, start_time=5.0, stop_time=stop_time)
        assert message == f"stopTime = {stop_time!r} s is refused; allowed is the startTime = 5.0 s and later"
        for allowed in (5.0, math.nextafter(5.0, 6.0), sys.float_info.max, math.inf):
            host.initialize(start_time=5.0, stop_time=allowed)
            host.fmu.reset()


def test_outputs_change_with_time_alone(built, tmp_path):
    with opened(built / "TwoMassDriveline.fmu", tmp_path) as host:
        host.initialize(v_0=10.0, T_0=50.0)
        seen = {host.get("v")}
        for k in range(3):
            host.step(0.01 * k, 0.01)
            seen.add(host.get("v"))
        assert len(seen) == 4


def test_a_new_instance_shows_what_it_would_start_with(built, tmp_path):
    with opened(built / "TwoMassDriveline.fmu", tmp_path) as host:
        block = FMUS["TwoMassDriveline"].block
        u, p = block.Input(), block.Parameters()
        for _ in range(2):
            assert tuple(host.outputs().values()) == tuple(block.output(block.start(u, p), u, p))
            host.initialize(v_0=10.0)
            host.step(0.0, 0.01)
            host.fmu.reset()


def test_calls_out_of_sequence_are_refused_and_a_right_sequence_goes_on(built, tmp_path):
    with opened(built / "MotorTorqueLoop.fmu", tmp_path) as host:
        assert "its place is after initialization" in host.refuses(host.step, 0.0, 0.001)
        assert "fmi2ExitInitializationMode is refused" in host.refuses(host.fmu.exitInitializationMode)
        host.fmu.setupExperiment()
        host.fmu.enterInitializationMode()
        assert "fmi2EnterInitializationMode is refused" in host.refuses(host.fmu.enterInitializationMode)
        assert "in initialization mode" in host.refuses(host.step, 0.0, 0.001)
        host.fmu.exitInitializationMode()
        assert "fmi2SetupExperiment is refused" in host.refuses(host.fmu.setupExperiment)
        host.step(0.0, 0.001)
        host.fmu.terminate()
        assert "fmi2DoStep is refused after termination" in host.refuses(host.step, 0.001, 0.001)
        assert "T_ref = 1.0 is refused; " in host.refuses(host.set, T_ref=1.0)
        host.fmu.reset()
        host.initialize()
        host.step(0.0, 0.001)

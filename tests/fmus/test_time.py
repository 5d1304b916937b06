"""The sequence of a run: initialization, communication steps of any length, time."""

import math
import sys
from itertools import cycle, repeat

from fmutesting.host import opened
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from fmublocks.block.types import SampledBlock

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


@together("off", [0.9e-6, -0.9e-6])
def test_the_clock_of_a_host_may_go_wrong_and_no_tick_moves(built, tmp_path, off):
    """A sum of 1e7 steps of 1 ms is 2 us off; here it is so after three steps, and 0.2 ms after 200."""
    block, time = FMUS["DampingController"].block, 0.0
    assert isinstance(block, SampledBlock)
    p = block.Parameters()
    x = coming = block.start(block.Input(), p)
    with opened(built / "DampingController.fmu", tmp_path) as host:
        host.initialize()
        for k in range(200):
            u = block.Input(T_driver=float(k % 7))
            host.set(T_driver=u.T_driver)
            host.step(time, 0.001)
            time += 0.001 + off
            x, coming = (coming, coming) if k % 2 else (x, block.update(x, u, p))
            assert tuple(host.outputs().values()) == tuple(block.output(x, u, p))


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


def test_an_input_that_is_fed_through_shows_before_the_step(motor):
    motor.initialize(sigma_omega=0.0, q_omega=0.0)
    motor.set(omega_1=123.0)
    assert motor.get("omega_1_meas") == 123.0


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


@together("step_size", [5e-324, 1000.0])
def test_the_shortest_and_the_longest_step_are_allowed(built, tmp_path, step_size):
    """Shown by a step that is refused for its time, which is looked at after its size."""
    with opened(built / "MotorTorqueLoop.fmu", tmp_path) as host:
        host.initialize()
        assert "currentCommunicationPoint = 7.0 s" in host.refuses(host.step, 7.0, step_size)


def test_a_step_that_does_not_move_time_is_refused(can):
    """Else a sampled block would stand still while all its steps are answered with OK."""
    can.initialize(start_time=1e17)
    message = "communicationStepSize = 0.001 s is refused; added to the time 1e+17 s it leaves it as it is"
    assert can.refuses(can.step, 1e17, 0.001) == message
    can.fmu.reset()
    can.initialize(start_time=1.0)
    can.step(1.0, math.ulp(1.0))


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


def test_any_finite_time_is_a_start_time(can):
    for time in (sys.float_info.max, -sys.float_info.max, 5.0):
        can.initialize(start_time=time)
        can.fmu.reset()


def test_a_run_ends_at_its_stop_time(can):
    can.initialize(start_time=1.0, stop_time=1.01)
    can.step(1.0, 0.009)
    before = can.outputs()
    message = can.refuses(can.step, 1.009, 0.001 + 1.01e-6)
    assert message == f"a step to {1.009 + (0.001 + 1.01e-6)!r} s is refused; the run was said to stop at 1.01 s"
    assert can.outputs() == before
    can.step(1.009, 0.001 + 0.99e-6)
    assert "stop at 1.01 s" in can.refuses(can.step, 1.01, 0.001)


def test_the_stop_time_is_kept_in_a_saved_state_and_forgotten_by_a_reset(can):
    can.initialize(stop_time=0.01)
    saved = can.fmu.serializeFMUstate(can.fmu.getFMUstate())
    can.fmu.reset()
    can.initialize()
    can.step(0.0, 0.02)
    can.fmu.setFMUstate(can.fmu.deSerializeFMUstate(saved))
    assert "stop at 0.01 s" in can.refuses(can.step, 0.0, 0.02)


@together("stop_time", [math.nextafter(5.0, 0.0), -math.inf, math.nan])
def test_a_run_does_not_stop_before_its_start(built, tmp_path, stop_time):
    with opened(built / "WheelSpeedCan.fmu", tmp_path) as host:
        message = host.refuses(host.initialize, start_time=5.0, stop_time=stop_time)
        assert message == f"stopTime = {stop_time!r} s is refused; allowed is the startTime = 5.0 s and later"
        for allowed in (5.0, math.nextafter(5.0, 6.0), sys.float_info.max, math.inf):
            host.initialize(start_time=5.0, stop_time=allowed)
            host.fmu.reset()


def test_a_new_instance_shows_what_it_would_start_with(plant):
    block = FMUS["TwoMassDriveline"].block
    u, p = block.Input(), block.Parameters()
    for _ in range(2):
        assert tuple(plant.outputs().values()) == tuple(block.output(block.start(u, p), u, p))
        plant.initialize(v_0=10.0)
        plant.step(0.0, 0.01)
        plant.fmu.reset()

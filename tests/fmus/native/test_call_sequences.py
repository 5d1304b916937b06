"""Right and wrong sequences of calls to native FMUs under the address and undefined-behaviour sanitizers.

Hypothesis draws the calls, a model of the standard's state machine says what each must answer, and the
program calls.c, compiled together with the sources of the FMU, makes them.
"""

import math
import subprocess
from copy import copy
from dataclasses import dataclass, field
from pathlib import Path

import fmpy
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)

from driveline.fmus.catalogue import FMUS
from driveline.fmus.description.variables import Variable, interface
from driveline.harness.loop.places import NATIVE
from tests.fuzz.calls import program
from tests.skipping import skipped_if_impossible
from tests.slow import slow

PROGRAM = Path(__file__).parent / "calls.c"
OK, DISCARD, ERROR = 0, 2, 3
BEFORE, DURING, AFTER, ENDED, EVENT, CONTINUOUS_TIME = range(6)
EXAMPLES, CALLS = 60, 40

any_number = st.floats(width=64) | st.sampled_from([0.0, 1.0, -30.0, 30.0])


@dataclass
class Expected:
    """What an instance must be like: whether it is for model exchange, where it is in the sequence of calls, its time,
    the values that were set (the states' under -1)."""

    exchange: bool = False
    mode: int = BEFORE
    time: float = 0.0
    values: dict[int, float] = field(default_factory=dict)

    def copy(self) -> "Expected":
        return Expected(self.exchange, self.mode, self.time, copy(self.values))


class Calls(RuleBasedStateMachine):
    """One instance of an FMU, run by calls.c."""

    command: list[str]
    reals: tuple[Variable, ...]
    states: int
    indicators: int
    tolerates_bad_input: bool

    def __init__(self) -> None:
        super().__init__()
        PIPE = subprocess.PIPE
        self.program = subprocess.Popen(self.command, text=True, stdin=PIPE, stdout=PIPE, stderr=PIPE)
        self.now = Expected()
        self.saved: Expected | None = None
        self.instantiate(False)

    def instantiate(self, exchange: bool) -> None:
        self.now, self.saved = Expected(exchange), None
        assert self.call("instantiate", int(exchange)) == (OK, 0.0)

    def call(self, name: str, reference: int = 0, number: float = 0.0) -> tuple[int, float]:
        """Status and number that the program answers."""
        assert self.program.stdin
        assert self.program.stdout
        self.program.stdin.write(f"{name} {reference} {number!r}\n")
        self.program.stdin.flush()
        answer = self.program.stdout.readline().split()
        assert answer, self.program.communicate()[1]
        return int(answer[0]), float(answer[1])

    def expect(self, allowed: bool, name: str, number: float = 0.0) -> None:
        """Makes a call that must be answered with OK if it is allowed, else with an error."""
        assert self.call(name, number=number)[0] == (OK if allowed else ERROR)

    def expect_of_exchange(self, modes: tuple[int, ...], name: str, number: float = 0.0) -> bool:
        """The same for a call of model exchange, allowed in some modes; says whether it is."""
        allowed = self.now.mode in modes
        self.expect(allowed, name, number)
        return allowed

    @initialize(exchange=st.booleans(), calls=st.integers(0, 4))
    def bring_to(self, exchange, calls):
        """Right calls first, so that every mode is met often."""
        if exchange and self.states:
            self.free_and_begin_again(True)
        integrating = [self.enter_continuous_time] if self.now.exchange else []
        for call in [self.enter, self.exit, *integrating, self.terminate][:calls]:
            call()

    @rule(start=any_number)
    def setup(self, start):
        allowed = self.now.mode == BEFORE and math.isfinite(start)
        self.expect(allowed, "setup", start)
        if allowed:
            self.now.time = start

    @rule()
    def enter(self):
        self.expect(self.now.mode == BEFORE, "enter")
        if self.now.mode == BEFORE:
            self.now.mode = DURING

    @rule()
    def exit(self):
        self.expect(self.now.mode == DURING, "exit")
        if self.now.mode == DURING:
            self.now.mode = EVENT if self.now.exchange else AFTER

    @precondition(lambda self: self.now.mode == AFTER and abs(self.now.time) < 1e3)
    @rule()
    def step(self):
        self.expect(True, "step")
        self.now.time += 1e-3

    @rule(number=st.sampled_from([-1.0, math.nan, math.inf]))
    def step_that_makes_no_sense(self, number):
        self.expect(False, "step_of", number)

    @rule(number=st.sampled_from([1000.0000000000001, 1e300]))
    def step_that_is_too_long(self, number):
        assert self.call("step_of", number=number)[0] == (DISCARD if self.now.mode == AFTER else ERROR)

    @rule()
    def cancel(self):
        self.expect(False, "cancel")

    @rule()
    def terminate(self):
        allowed = self.now.mode in (AFTER, EVENT, CONTINUOUS_TIME)
        self.expect(allowed, "terminate")
        if allowed:
            self.now.mode = ENDED

    @rule()
    def reset(self):
        self.expect(True, "reset")
        self.now = Expected(self.now.exchange)

    @rule(exchange=st.booleans())
    def free_and_begin_again(self, exchange):
        self.expect(True, "free")
        self.instantiate(exchange and self.states > 0)

    @precondition(lambda self: self.states)
    @rule()
    def enter_event(self):
        if self.expect_of_exchange((EVENT, CONTINUOUS_TIME), "enter_event"):
            self.now.mode = EVENT

    @precondition(lambda self: self.states)
    @rule()
    def enter_continuous_time(self):
        if self.expect_of_exchange((EVENT,), "enter_continuous"):
            self.now.mode = CONTINUOUS_TIME

    @precondition(lambda self: self.states)
    @rule()
    def iterate(self):
        self.expect_of_exchange((EVENT,), "new_states")
        self.expect_of_exchange((CONTINUOUS_TIME,), "completed")

    @precondition(lambda self: self.states)
    @rule(time=any_number)
    def set_time(self, time):
        modes = (EVENT, CONTINUOUS_TIME) if math.isfinite(time) else ()
        if self.expect_of_exchange(modes, "set_time", time):
            self.now.time = time

    @precondition(lambda self: self.states)
    @rule(number=any_number, more=st.sampled_from((0, 0, 1, -1)))
    def set_states(self, number, more):
        allowed = self.now.mode == CONTINUOUS_TIME and not more
        expected = ERROR if not allowed else OK if math.isfinite(number) else DISCARD
        assert self.call("set_states", self.states + more, number)[0] == expected
        if expected == OK:
            self.now.values[-1] = number

    @precondition(lambda self: self.states)
    @rule(name=st.sampled_from(("states", "rates", "indicators", "nominals")), more=st.sampled_from((0, 0, 1, -1)))
    def get_of_exchange(self, name, more):
        modes = (DURING, EVENT, CONTINUOUS_TIME, ENDED) + ((BEFORE,) if name == "nominals" else ())
        count = more + (self.indicators if name == "indicators" else self.states)
        status, _ = self.call(name, count)
        allowed = self.now.exchange and self.now.mode in modes and not more
        assert status == (OK if allowed else ERROR) or (status, allowed, name) == (
            DISCARD,
            bool(self.now.values),
            "rates",
        )

    @rule(data=st.data())
    def set(self, data):
        causality = data.draw(st.sampled_from(("input", "parameter", "output")))
        variable = data.draw(st.sampled_from([v for v in self.reals if v.causality == causality]))
        low, high = variable.bounds()
        value = data.draw(any_number | st.floats(low, high))
        allowed = {
            "input": (BEFORE, DURING, AFTER, EVENT, CONTINUOUS_TIME),
            "fixed": (BEFORE, DURING),
            "tunable": (BEFORE, DURING, AFTER, EVENT),
            "output": (),
        }[variable.variability or causality]
        any_value = causality == "input" and self.tolerates_bad_input
        expected = self.now.mode in allowed and (low <= value <= high or any_value)
        assert self.call("set", variable.reference, value)[0] == (OK if expected else ERROR), variable.name
        if expected:
            self.now.values[variable.reference] = value

    @rule()
    def save(self):
        self.expect(True, "save")
        self.saved = self.now.copy()

    @rule(through_bytes=st.booleans())
    def restore(self, through_bytes):
        if through_bytes:
            self.expect(self.saved is not None, "through_bytes")
        self.expect(self.saved is not None, "restore")
        if self.saved:
            self.now = self.saved.copy()

    @rule()
    def drop(self):
        self.expect(True, "drop")
        self.saved = None

    @invariant()
    def values_are_those_that_were_set(self):
        for variable in self.reals:
            status, value = self.call("get", variable.reference)
            assert status == OK
            if variable.causality != "output":
                expected = self.now.values.get(variable.reference, variable.start)
                assert value == pytest.approx(expected, rel=0.0, abs=0.0, nan_ok=True)
            elif not self.now.values:
                assert math.isfinite(value)

    @invariant()
    def time_is_that_of_the_last_step(self):
        known = self.now.mode in (AFTER, ENDED) and not self.now.exchange
        status, time = self.call("time")
        assert (status, time) == ((OK, pytest.approx(self.now.time)) if known else (ERROR, 0.0))

    def teardown(self):
        if self.program.poll() is None:
            self.call("free")
        _, message = self.program.communicate()
        assert (self.program.returncode, message) == (0, "")


def run_calls(calls: type[Calls], fmu: Path, folder: Path) -> None:
    with skipped_if_impossible():
        of_fmu = program(fmu, folder, PROGRAM)
    block, described = FMUS[fmu.stem].block, fmpy.read_model_description(str(fmu))

    class CallsOfThisFmu(calls):
        command = of_fmu
        states, indicators = described.numberOfContinuousStates, described.numberOfEventIndicators
        reals = tuple(v for v in interface(block) if v.fmi_type == "Real")
        tolerates_bad_input = block.tolerates_bad_input

    run_state_machine_as_test(
        CallsOfThisFmu, settings=settings(max_examples=EXAMPLES, stateful_step_count=CALLS, deadline=None)
    )


@pytest.mark.parametrize("name", slow(FMUS, but=("MotorTorqueLoop",)))
@pytest.mark.slow
def test_every_call_is_answered_as_the_standard_asks_and_the_sanitizers_find_nothing(both_built, tmp_path, name):
    run_calls(Calls, both_built / NATIVE / f"{name}.fmu", tmp_path)


class CallsOfFmi3(Calls):
    """What is different: the start time is told by what enters initialization mode; the time is a variable."""

    @rule(start=any_number)
    def setup(self, start):
        allowed = self.now.mode == BEFORE and math.isfinite(start)
        self.expect(allowed, "setup", start)
        if allowed:
            self.now.mode, self.now.time = DURING, start

    @invariant()
    def time_is_that_of_the_last_step(self):
        assert self.call("time") == (OK, pytest.approx(self.now.time))


@pytest.mark.parametrize("name", slow(FMUS, but=("MotorTorqueLoop",)))
@pytest.mark.slow
def test_every_call_to_fmi_3_is_answered_so_too(fmi3, tmp_path, name):
    run_calls(CallsOfFmi3, fmi3 / f"{name}.fmu", tmp_path)

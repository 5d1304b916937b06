"""Right and wrong sequences of calls to FMUs of FMI 3.0: those of FMI 2.0, through fmi3/fmi2Functions.h."""

import math

import pytest
from hypothesis.stateful import invariant, rule

from driveline.fmus.catalogue import FMUS
from tests.fmus.native.test_call_sequences import BEFORE, DURING, OK, Calls, any_number, run_calls
from tests.slow import slow


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
def test_every_call_is_answered_as_the_standard_asks_and_the_sanitizers_find_nothing(fmi3, tmp_path, name):
    run_calls(CallsOfFmi3, fmi3 / f"{name}.fmu", tmp_path)

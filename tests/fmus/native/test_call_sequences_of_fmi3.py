"""Right and wrong sequences of calls to FMUs of FMI 3.0: those of FMI 2.0, through fmi3/fmi2Functions.h."""

import math
import subprocess

import fmpy
import pytest
from hypothesis import settings
from hypothesis.stateful import invariant, rule, run_state_machine_as_test

from driveline.fmus.catalogue import FMUS
from driveline.fmus.description.variables import interface
from driveline.fmus.native.compiler import host_compiler
from tests.fmus.native.test_call_sequences import (
    BEFORE,
    CALLS,
    DURING,
    EXAMPLES,
    OK,
    PROGRAM,
    SANITIZERS,
    WARNINGS,
    Calls,
    any_number,
)
from tests.fuzz.calls import as_fmi2
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
def test_every_call_is_answered_as_the_standard_asks_and_the_sanitizers_find_nothing(fmi3, tmp_path, name):
    path = fmi3 / f"{name}.fmu"
    fmpy.extract(str(path), str(tmp_path))
    program = tmp_path / "calls"
    description = fmpy.read_model_description(str(path))
    command = [host_compiler(), *WARNINGS, "-Wno-strict-prototypes", *SANITIZERS, *as_fmi2(description), "-I."]
    compiled = subprocess.run(
        [*command, PROGRAM, "all.c", "-o", program, "-lm"],
        cwd=tmp_path / "sources",
        capture_output=True,
        text=True,
        check=False,
    )
    if "cannot find" in compiled.stderr:
        pytest.skip("the compiler has no sanitizers")
    assert compiled.returncode == 0, compiled.stderr
    block = FMUS[name].block

    class CallsOfThisFmu(CallsOfFmi3):
        command = (str(program), str(description.guid))
        states, indicators = 0, 0
        reals = tuple(v for v in interface(block) if v.fmi_type == "Real")
        tolerates_bad_input = block.tolerates_bad_input

    run_state_machine_as_test(
        CallsOfThisFmu, settings=settings(max_examples=EXAMPLES, stateful_step_count=CALLS, deadline=None)
    )

"""Whatever an FMU of somebody else's does: one line that names it and the call, and nothing is left behind."""

import json
import pickle
import re
import subprocess
import sys
import time
import zipfile
from io import BytesIO
from itertools import product
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmutesting.foreign import tampered
from fmutesting.foreign.stranger import build_stranger, in_words_of
from fmutesting.slow import slow

from driveline.harness.loop.settings import loop as looped
from fmuloop import isolated_process
from fmuloop.call_trace import current, note
from fmuloop.compiled_steps import LIBRARY, CompiledSteps
from fmuloop.errors import RunEnded, SimulationError, UnpackingError, WiringError
from fmuloop.experiment import Experiment
from fmuloop.isolated_process import IsolatedProcess
from fmuloop.limits import Limits
from fmuloop.loading import loaded
from fmuloop.process_answers import LENGTH, Answer, InvalidAnswer, receive, send
from fmuloop.runs import kept_loaded, run
from fmuloop.steps import interpreted
from fmuloop.system import Scheme, System
from tests import ROOT

LATER = "if (time > 0.0995)"

FAULTS = {
    "exits in a step": (
        {"IN_DO_STEP": f"{LATER} exit(0)"},
        r"ended the process that it ran in, with exit code 0, in fmi2DoStep at 0\.1 s",
    ),
    "ends at once": ({"IN_DO_STEP": f"{LATER} _exit(7)"}, r"with exit code 7, in fmi2DoStep at 0\.1 s"),
    "exits when instantiated": ({"IN_INSTANTIATE": "exit(0)"}, r"with exit code 0, in fmi2Instantiate"),
    "is not instantiated": ({"IN_INSTANTIATE": "return 0"}, r"cannot be instantiated: Failed to instantiate model"),
    "crashes in a step": (
        {"IN_DO_STEP": f"{LATER} *(volatile int *)8 = 1"},
        r"crashed \(SIGSEGV\) in fmi2DoStep at 0\.1 s",
    ),
    "aborts": ({"IN_GET_REAL": "if (now > 0.0995) abort()"}, r"crashed \(SIGABRT\) in fmi2GetReal at 0\.1 s"),
    "crashes when instantiated": ({"IN_INSTANTIATE": "raise(SIGSEGV)"}, r"crashed \(SIGSEGV\) in fmi2Instantiate$"),
    "ends by a signal of real time": (
        {"IN_DO_STEP": f"{LATER} raise(SIGRTMIN + 6)"},
        r"crashed \(signal 4\d\) in fmi2DoStep at 0\.1 s",
    ),
    "hangs in a step": (
        {"IN_DO_STEP": f"{LATER} for (;;) usleep(1000)"},
        r"did not return from fmi2DoStep at 0\.1 s within 0\.5 s",
    ),
    "hangs when instantiated": (
        {"IN_INSTANTIATE": "for (;;) usleep(1000)"},
        r"did not return from fmi2Instantiate within 0\.5 s",
    ),
    "is pending": (
        {"IN_DO_STEP": f"{LATER} return 5"},
        r"answered fmi2DoStep at 0\.1 s with pending: it works asynchr",
    ),
    "has the status -1": ({"IN_DO_STEP": f"{LATER} return -1"}, r"answered fmi2DoStep at 0\.1 s with the status -1"),
    "has the status 17": ({"IN_DO_STEP": f"{LATER} return 17"}, r"answered fmi2DoStep at 0\.1 s with the status 17"),
    "has the status -1 first": ({"IN_GET_REAL": "return -1"}, r"answered fmi2GetReal at the start with the status -1"),
    "puts out NaN": (
        {"IN_GET_REAL": "if (now > 0.0995) values[4] = NAN"},
        r": T_gear is nan in the step from 0\.099 s",
    ),
    "puts out infinity": (
        {"IN_GET_REAL": "if (now > 0.0995) values[0] = values[5] = -INFINITY"},
        r": omega_1 is -inf and 1 more in the step from 0\.099 s",
    ),
    "puts out NaN at the start": ({"IN_GET_REAL": "values[5] = NAN"}, r": v is nan at the start"),
    "logs escape sequences": ({"IN_DO_STEP": f"{LATER} {{ say_much(); return 3; }}"}, r"at 0\.1 s with error: \[31m"),
}


every_fmi = pytest.mark.parametrize("fmi", [2, 3])


OF_EACH_CALL = ("exits in a step", "is not instantiated", "aborts", "puts out NaN")
"""Faults that meet every call whose name and arguments are others in FMI 3.0."""


@pytest.mark.parametrize(
    ("fault", "fmi"),
    slow(product(FAULTS, (2, 3)), but=[*((fault, 2) for fault in FAULTS), *((fault, 3) for fault in OF_EACH_CALL)]),
)
def test_a_stranger_is_named_with_its_call(tmp_path, unpacked, fault, fmi):
    does, message = FAULTS[fault]
    system = System({"car": build_stranger(tmp_path, fmi=fmi, **does)}, limits=Limits(call=0.5))
    with pytest.raises(SimulationError, match=in_words_of(fmi, message)) as error:
        run(system, Experiment(0.3))
    text = str(error.value)
    assert text.startswith("car (stranger.fmu)")
    assert len(text) < 700
    assert text.isprintable()
    assert list(unpacked.iterdir()) == []


@every_fmi
@pytest.mark.parametrize("fault", ["exits in a step", "puts out NaN", "has the status -1", "aborts"])
def test_the_steps_in_python_name_the_same(tmp_path, fault, fmi):
    does, message = FAULTS[fault]
    system = System({"car": build_stranger(tmp_path, fmi=fmi, **does)})
    with (
        pytest.raises(SimulationError, match=in_words_of(fmi, message)),
        loaded(system, make_steps=interpreted) as loop,
    ):
        loop.run(Experiment(0.3))


@every_fmi
@pytest.mark.parametrize("make", [CompiledSteps, interpreted])
@pytest.mark.parametrize("own", [False, True])
def test_the_rows_up_to_the_end_that_an_fmu_asks_for_are_the_result(tmp_path, make, fmi, own):
    """In a process of its own, or in this one as those of the project, where it is not watched for in FMI 3.0."""
    if own and fmi == 3 and make is CompiledSteps:
        pytest.skip("those of the project never ask")
    ends = {
        "IN_DO_STEP": f"{LATER} return 2",
        "IN_GET_BOOLEAN_STATUS": "if (kind == 3) { *value = 1; return 0; }",
    }
    path = build_stranger(tmp_path, fmi=fmi, IN_GET_REAL="values[0] = now", **ends)
    with loaded(System({"car": path}, own=frozenset(["car"] * own)), make_steps=make) as loop:
        for _ in range(2):
            results = loop.run(Experiment(0.3))
            np.testing.assert_allclose(results["time"], 1e-3 * np.arange(101), atol=1e-12)
            np.testing.assert_allclose(results[list(results.dtype.names or [])[1]], results["time"], atol=1e-12)
            assert pickle.loads(pickle.dumps(results[1:])).ended == ("car (stranger.fmu)", pytest.approx(0.1))


def test_an_fmu_that_ends_the_run_in_its_first_step_is_named(tmp_path):
    ends: dict[str, Any] = {"IN_DO_STEP": "return 2"}
    ends["IN_GET_BOOLEAN_STATUS"] = "if (kind == 3) { *value = 1; return 0; }"
    system = System({"car": build_stranger(tmp_path, **ends)})
    with pytest.raises(RunEnded, match=r"^car \(stranger\.fmu\) ended the run in its first step: there is nothing to"):
        run(system, Experiment(0.3))


AFTERWARDS = {
    "IN_FREE": ("raise(SIGSEGV)", r"crashed \(SIGSEGV\) in fmi2FreeInstance"),
    "IN_TERMINATE": ("return 3", "answered fmi2Terminate with error: no message"),
    "IN_TERMINATE ": ("raise(SIGSEGV)", r"crashed \(SIGSEGV\) in fmi2Terminate"),
}
"""What goes wrong after a whole run."""


@pytest.mark.parametrize(("when", "fmi"), slow(product(AFTERWARDS, (2, 3)), but=[(when, 2) for when in AFTERWARDS]))
def test_a_run_that_is_over_is_not_lost(tmp_path, unpacked, caplog, when, fmi):
    does, message = AFTERWARDS[when]
    faulty: dict[str, Any] = {when.strip(): does}
    results = run(System({"car": build_stranger(tmp_path, fmi=fmi, **faulty)}), Experiment(0.3))
    assert len(results) == 301
    (said,) = [each.getMessage() for each in caplog.records]
    assert re.fullmatch(rf"car \(stranger\.fmu\) {in_words_of(fmi, message)}; the results are kept", said)
    assert list(unpacked.iterdir()) == []


def test_functions_that_nobody_calls_may_be_missing(tmp_path):
    without: dict[str, Any] = {"fmi2CancelStep": "anotherName", "fmi2GetDirectionalDerivative": "another"}
    assert len(run(System({"car": build_stranger(tmp_path, **without)}), Experiment(0.01))) == 11
    with pytest.raises(SimulationError, match="DoStep"):
        run(System({"car": build_stranger(tmp_path, fmi2DoStep="anotherName")}), Experiment(0.01))


@every_fmi
def test_a_binary_in_the_folder_of_the_other_version_is_found(tmp_path, fmi):
    path, other = build_stranger(tmp_path, fmi=fmi), tmp_path / "other.fmu"
    folders = [fmpy.platform, fmpy.platform_tuple]
    with zipfile.ZipFile(path) as source, zipfile.ZipFile(other, "w") as target:
        for name in source.namelist():
            target.writestr(name.replace(folders[fmi - 2], folders[3 - fmi]), source.read(name))
    assert len(run(System({"car": other}), Experiment(0.01))) == 11


SHORT = "if (step < 0.0099) return 2"


@pytest.mark.parametrize("ended", [False, True])
@every_fmi
@pytest.mark.parametrize("make", [CompiledSteps, interpreted])
def test_an_fmu_that_refuses_short_steps_makes_its_own(tmp_path, fmi, make, ended, caplog):
    """Ten steps of the loop long: inputs are held over it, outputs from its end on. Some refuse by asking for the end
    of the run (PythonFMU)."""
    asks = {"IN_GET_BOOLEAN_STATUS": "if (kind == 3) { *value = 1; return 0; }"} if ended else {}
    outputs = "if (n > 1) values[0] = now, values[1] = kept[0]"
    path = build_stranger(tmp_path, fmi=fmi, IN_DO_STEP=SHORT, IN_GET_REAL=outputs, **asks)
    path = tampered(path, tmp_path / "slow.fmu", lambda xml: xml.replace('stepSize="0.001"', 'stepSize="0.01"'))
    k = np.arange(36)
    with loaded(System({"car": path}), make_steps=make) as loop:
        for scheme in Scheme:
            results = loop.run(Experiment(0.035, inputs={"car.T_mot": k}, scheme=scheme))
            np.testing.assert_allclose(results["car.omega_1"], 0.01 * (k // 10), atol=1e-12)
            late = 0 if scheme is Scheme.PROPAGATED else 10
            np.testing.assert_array_equal(results["car.omega_2"], np.maximum(k // 10 * 10 - late, 0))
            assert results.remarks == {"own_steps": {"car": 0.01}}
    (said,) = [each.getMessage() for each in caplog.records]
    assert said.startswith("car (slow.fmu) refuses steps of 0.001 s and makes its own, of 0.01 s; its inputs and")


NO_MULTIPLE = "; its own step of 0.0015 s is no multiple of the loop's 0.001 s"


@pytest.mark.parametrize(("own", "refuses", "why"), [("0.01", "0.02", ""), ("0.0015", "0.0012", NO_MULTIPLE)])
def test_an_fmu_whose_own_step_is_refused_or_no_multiple_is_refused(tmp_path, own, refuses, why):
    path = build_stranger(tmp_path, IN_DO_STEP=f"if (step < {refuses}) return 3")
    path = tampered(path, tmp_path / "slow.fmu", lambda xml: xml.replace('stepSize="0.001"', f'stepSize="{own}"'))
    with pytest.raises(SimulationError, match=rf"answered fmi2DoStep at 0(\.009)? s with error: no message{why}$"):
        run(System({"car": path}), Experiment(0.03))


@every_fmi
def test_a_step_that_is_discarded_without_an_end_is_refused(tmp_path, fmi):
    system = System({"car": build_stranger(tmp_path, fmi=fmi, IN_DO_STEP=f"{LATER} return 2")})
    with pytest.raises(SimulationError, match=in_words_of(fmi, r"answered fmi2DoStep at 0\.1 s with discard")):
        run(system, Experiment(0.3))


@every_fmi
@pytest.mark.parametrize(
    ("declared", "given", "expected"), [("", None, -1.0), ("2e-3", None, 2e-3), ("2e-3", 1e-7, 1e-7)]
)
def test_a_tolerance_is_passed_on(tmp_path, fmi, declared, given, expected):
    path = build_stranger(tmp_path, fmi=fmi, IN_GET_REAL="values[0] = tolerance_given")
    if declared:
        change = ("<DefaultExperiment", f'<DefaultExperiment tolerance="{declared}"')
        path = tampered(path, tmp_path / "theirs.fmu", lambda xml: xml.replace(*change))
    results = run(System({"car": path}), Experiment(0.01, tolerance=given))
    assert set(results[list(results.dtype.names or [])[1]]) == {expected}


@every_fmi
def test_the_first_row_has_the_outputs_after_initialization(tmp_path, fmi):
    path = build_stranger(tmp_path, fmi=fmi, IN_GET_REAL="values[0] = initialized ? 353429.0 : 0.0")
    results = run(System({"car": path}), Experiment(0.01))
    assert set(results[list(results.dtype.names or [])[1]]) == {353429.0}


@pytest.mark.skipif(LIBRARY is None, reason="the project was installed without a C compiler")
def test_every_call_is_counted_in_both_languages(native):
    counted = []
    for make in (CompiledSteps, interpreted):
        with loaded(looped(folder=native.parent, build="native"), make_steps=make) as loop:
            before = current().calls
            loop.run(Experiment(0.1))
            counted.append(current().calls - before)
    assert counted[0] == counted[1] > 100 * 4


def test_a_stranger_that_cuts_off_its_process_has_not_crashed(tmp_path, monkeypatch):
    monkeypatch.setattr(isolated_process, "PATIENCE", 0.3)
    does = f"{LATER} {{ for (int k = 3; k < 20; k++) close(k); for (;;) usleep(1000); }}"
    with pytest.raises(SimulationError, match=r"gave no more answers and was ended, in fmi2DoStep at 0\.1 s"):
        run(System({"car": build_stranger(tmp_path, IN_DO_STEP=does)}), Experiment(0.3))


class Slow(list):
    """Texts that take 0.5 s to be sent."""

    def __iter__(self):
        time.sleep(0.5)
        return super().__iter__()


def slow_after_a_call():
    note(0, "fmi2Terminate")
    return Slow(["slow"])


def test_writing_a_large_answer_is_no_call_that_hangs():
    process = IsolatedProcess(["stranger.fmu"], 0.2)
    assert process.ask(slow_after_a_call) == ["slow"]
    process.close()


FORGED = """
for (int k = 3; k < 20; k++) {
    static const char answer[] = BYTES;
    write(k, answer, sizeof answer - 1);
}
for (;;) usleep(1000)
"""


def in_c(content: bytes) -> str:
    return '"' + "".join(f"\\{byte:03o}" for byte in content) + '"'


class Harmful:
    """What leaves a file behind when it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)


def reader(pipe):
    """As of a process that has ended."""

    def read(size):
        content = pipe.read(size)
        if len(content) < size:
            raise EOFError
        return bytearray(content)

    return read


def framed(header):
    line = json.dumps(header).encode()
    return LENGTH.pack(len(line)) + line


@pytest.mark.parametrize(
    "noted", [b"", b"\xff" * 16, np.array([0, 6, 0, 0x7FF00000], np.int32).tobytes()], ids=["", "no FMU", "infinity"]
)
def test_nothing_that_a_stranger_writes_among_the_answers_is_run(tmp_path, noted):
    """It writes over the page where its calls are noted, too: before the answer is seen, or after."""
    pickled = noted + pickle.dumps((Harmful(tmp_path / "harm"), None))
    does = " ".join(FORGED.replace("BYTES", in_c(pickled)).split())
    with pytest.raises(SimulationError, match=r"wrote among the answers .* in (fmi2DoStep at 0 s|no call of FMI)$"):
        run(System({"car": build_stranger(tmp_path, IN_DO_STEP=does)}), Experiment(0.3))
    assert not (tmp_path / "harm").exists()


@pytest.mark.parametrize(
    "bytes_",
    [
        LENGTH.pack(2**63),
        framed({"texts": [], "size": 2**62, "error": None}),
        framed({"texts": [1], "size": 3, "error": None}),
        framed({"texts": "abc", "size": 3, "error": None}),
        framed({"texts": [], "size": 3}),
        framed({"texts": [], "size": 3, "error": ["SimulationError"]}),
        framed(["texts"]),
        LENGTH.pack(10**5) + b"[" * 10**5,
    ],
)
def test_what_is_no_answer_to_the_question_is_forged(bytes_):
    with pytest.raises(InvalidAnswer):
        receive(reader(BytesIO(bytes_)), 3)


def test_a_stranger_without_a_binary_for_this_machine_tells_of_the_machine_and_not_of_the_run(tmp_path, native):
    path = tmp_path / "Theirs.fmu"
    with zipfile.ZipFile(native / "TwoMassDriveline.fmu") as whole, zipfile.ZipFile(path, "w") as without:
        for name in whole.namelist():
            if not name.startswith("binaries/"):
                without.writestr(name, whole.read(name))
    with pytest.raises(UnpackingError, match=r"^Theirs\.fmu has no binary for \w+; it has: none$"):
        run(System({"plant": path}), Experiment(0.01))


def test_an_answer_arrives_as_it_was_sent():
    pipe = BytesIO()
    send(Answer(("one", "two")), pipe)
    send(Answer(content=b"abc"), pipe)
    send(Answer(error=WiringError("wrong")), pipe)
    send(Answer(error=ValueError("odd\033[31m")), pipe)
    pipe.seek(0)
    assert receive(reader(pipe), 0) == Answer(["one", "two"])
    assert receive(reader(pipe), 3) == Answer([], b"abc")
    answers = [receive(reader(pipe), 3) for _ in range(2)]
    assert [(type(answer.error), str(answer.error)) for answer in answers] == [
        (WiringError, "wrong"),
        (SimulationError, "ValueError: odd [31m"),
    ]
    with pytest.raises(EOFError):
        receive(reader(pipe), 0)


@pytest.mark.parametrize(("length", "error"), [(10**8, EOFError), (10**8 + 1, InvalidAnswer)])
def test_an_answer_that_is_longer_than_any_is_not_waited_for(length, error):
    with pytest.raises(error):
        receive(reader(BytesIO(LENGTH.pack(length))), 0)


@pytest.mark.parametrize("own_session", ["", "setsid();"])
def test_what_a_stranger_leaves_behind_is_not_waited_for(tmp_path, own_session):
    """A child that it has forked holds the pipe of the answers for 20 s."""
    does = f"{LATER} {{ if (fork() == 0) {{ {own_session} sleep(20); _exit(0); }} _exit(3); }}"
    begun = time.monotonic()
    with pytest.raises(SimulationError, match=r"with exit code 3, in fmi2DoStep at 0\.1 s"):
        run(System({"car": build_stranger(tmp_path, IN_DO_STEP=does)}), Experiment(0.3))
    assert time.monotonic() - begun < 10.0


RUN = """
import sys
from pathlib import Path
from fmuloop.experiment import Experiment
from fmuloop.runs import run
from fmuloop.system import System

for _ in range(2): run(System(dict(zip("ab", map(Path, sys.argv[1:])))), Experiment(0.1))
"""


def test_what_strangers_print_goes_nowhere_and_the_process_of_the_master_ends_well(tmp_path, relay):
    path = build_stranger(tmp_path, IN_DO_STEP='puts("hello"), fprintf(stderr, "hello")', IN_FREE="fflush(0)")
    command = [sys.executable, "-c", RUN, path, relay]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.slow
def test_a_slow_stranger_may_take_longer_than_one_call(tmp_path):
    system = System({"car": build_stranger(tmp_path, IN_DO_STEP="usleep(100000)")}, limits=Limits(call=0.4))
    begun = time.monotonic()
    assert len(run(system, Experiment(1.0, 0.1))) == 11
    assert time.monotonic() - begun > 1.0


def test_a_stranger_keeps_its_process_and_gets_a_new_one_after_a_crash(tmp_path, unpacked):
    crash: Any = {"IN_DO_STEP": "if (time > 0.1) raise(SIGSEGV)"}
    system = System({"car": build_stranger(tmp_path, **crash)})
    with kept_loaded():
        run(system, Experiment(0.1))
        first = list(unpacked.iterdir())
        run(system, Experiment(0.1))
        assert list(unpacked.iterdir()) == first
        for _ in range(2):
            with pytest.raises(SimulationError, match="crashed"):
                run(system, Experiment(0.2))
        np.testing.assert_array_equal(run(system, Experiment(0.1))["car.v"], 0.0)
    assert list(unpacked.iterdir()) == []

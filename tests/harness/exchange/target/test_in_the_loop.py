"""The controller on the emulated target in the loop: an FMU like any other, whose results are those of off-line."""

import os
import signal
import subprocess
import time
from pathlib import Path
from threading import Thread

import numpy as np
import pytest

from driveline.fmus.catalogue import CONTROLLERS
from driveline.harness.exchange.target.comparison import responses
from driveline.harness.exchange.target.controllers import Programs
from driveline.harness.exchange.target.offline_cases import Case
from driveline.harness.loop.places import CONNECTIONS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import at_samples
from driveline.harness.simulation.simulate import signals, simulate
from driveline.models.damping_controller import BLOCK
from fmublocks.native.statements import SINGLE
from fmublocks.target.image import build_on_target, target_image
from fmublocks.target.link import Link, TargetError, emulated
from fmublocks.target.sources import target_sources
from fmuloop.errors import SimulationError
from fmuloop.system import Scheme

TIPIN, LONG = MANOEUVRES["tipin15"], MANOEUVRES["drive"]


@pytest.fixture(scope="module")
def on_target(target: Programs, tmp_path_factory: pytest.TempPathFactory) -> Path:
    assert target
    return build_on_target(CONTROLLERS["DampingController"], tmp_path_factory.mktemp("on_target"))


def simulated(controller: Path | None, fmus: Path, manoeuvre: object = TIPIN, **settings: object) -> np.ndarray:
    return simulate(manoeuvre, controller=controller, folder=fmus, build="native", **settings)  # type: ignore[arg-type]


def emulators(folder: Path) -> set[int]:
    """Processes of the emulator that run an image that was unpacked in a folder."""
    command = ["pgrep", "-f", f"^qemu-system-arm.*{folder}"]
    return set(map(int, subprocess.run(command, capture_output=True, text=True, check=False).stdout.split()))


@pytest.mark.parametrize(
    ("scheme", "plant"),
    [*((scheme, "TwoMassDriveline") for scheme in Scheme), (Scheme.PROPAGATED, "ValidationVehicle")],
)
def test_the_loop_gives_what_the_same_c_gives_off_line(scheme, plant, on_target, target, both_built) -> None:
    results = at_samples(simulated(on_target, both_built, plant=plant, scheme=scheme))
    sources = {name: name for name in signals(TIPIN)} | {to: source for source, to, _ in CONNECTIONS}
    free = {f"controller.{name}": value for name, value in BLOCK.Input()._asdict().items()}
    unconnected = {name: np.full(len(results), value) for name, value in free.items() if name not in sources}
    inputs = np.column_stack([results[sources[n]] if n in sources else unconnected[n] for n in free])
    if scheme is Scheme.PROPAGATED:  # the others give the controller its inputs a step late
        off_line = responses(target.single(), Case("", BLOCK.Input._fields, inputs))
        assert [answer.outputs[0] for answer in off_line] == results["controller.T_ref"].tolist()
    double = at_samples(simulated(None, both_built, plant=plant, scheme=scheme))
    assert np.max(np.abs(results["controller.T_ref"] - double["controller.T_ref"])) < 0.05
    assert np.ptp(results["controller.T_ref"]) > 50.0


def test_parameters_and_the_switch_of_the_loop_reach_the_target(on_target: Path, both_built: Path) -> None:
    limited = simulated(on_target, both_built, parameters={"controller.T_max": 40.0})
    assert limited["controller.T_ref"].max() == 40.0
    results = at_samples(simulated(on_target, both_built, control=False))
    demand = results["controller.T_driver"][:-1].astype(np.float32)
    np.testing.assert_array_equal(results["controller.T_ref"][1:], demand)


def all_ended(folder: Path) -> bool:
    """Whether no emulator runs, or none after some seconds."""
    end = time.monotonic() + 5.0
    while emulators(folder) and time.monotonic() < end:
        time.sleep(0.05)
    return not emulators(folder)


def test_no_emulator_is_left_after_a_run(on_target: Path, both_built: Path, unpacked: Path) -> None:
    simulated(on_target, both_built)
    assert all_ended(unpacked)


SIGNALS = {signal.SIGKILL: "was lost: ended by SIGKILL", signal.SIGSTOP: "hangs: no answer within 1 s"}
"""To the emulator, and what is said of the target then."""


@pytest.mark.parametrize("number", SIGNALS)
def test_a_target_that_is_lost_or_hangs_is_named_and_nothing_is_left(number, on_target, both_built, unpacked) -> None:
    sent = []

    def disturb() -> None:
        while not (found := emulators(unpacked)):
            time.sleep(0.02)
        time.sleep(0.3)
        for process in found:
            os.kill(process, number)
        sent.append(time.monotonic())

    thread = Thread(target=disturb)
    thread.start()
    with pytest.raises(SimulationError, match=f"DampingController on the emulated target {SIGNALS[number]}"):
        simulated(on_target, both_built, LONG, step_size=5e-4)
    thread.join()
    assert time.monotonic() - sent[0] < 3.0
    assert all_ended(unpacked)


def test_a_fault_of_the_processor_is_named(target: Programs, tmp_path: Path) -> None:
    """An instruction that does not exist, where the controller computes."""
    sources = target_sources(CONTROLLERS["DampingController"], SINGLE)
    first = "const float a1 ="
    broken = {name: text.replace(first, f"__builtin_trap(); {first}", 1) for name, text in sources.items()}
    assert target
    crashed = pytest.raises(TargetError, match="the target crashed: a fault of the processor")
    with Link(emulated(target_image(broken, tmp_path)), "the target") as link, crashed:
        link.start(BLOCK.Input())

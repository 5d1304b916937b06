"""Every command runs with the smallest FMUs that the documentation has, built with pythonfmu alone, without units."""

from pathlib import Path
from typing import Any

import pytest
from fmutesting.foreign import CAR, SMALLEST_CONTROLLER, build_relay

from driveline.fmus.catalogue import EVERY, SIGNAL_FAULTS
from driveline.harness.commands.cli import main
from driveline.harness.loop.places import NO_DAMPING
from tests.harness.commands import Capsys
from toolground.collected_warnings import warn_once

COMMANDS = {
    "simulate": ["--manoeuvre", "tipin15"],
    "compare": ["--manoeuvre", "tipin15", "--figures", "png"],
    "robustness": ["--cases", "1"],
    "replay": ["trip.csv", "--figures", "png"],
    "faults": ["--cases", "1"],
    "record": ["--duration", "4"],
    "ssp": [],
}

TRIP = "Time [s],Velocity [m/s],Motor Torque [Nm]\n" + "".join(
    f"{0.1 * k:.1f},{5.0 + 0.01 * k:.3f},{15 + k % 7}\n" for k in range(100)
)


@pytest.fixture(scope="module")
def blocks(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("smallest")
    return {"plant": build_relay(folder, CAR), "controller": build_relay(folder, SMALLEST_CONTROLLER)}


def test_what_the_loop_runs_without_is_said_once_a_command_and_never_with_quiet(
    blocks: dict[str, Path], native: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    plant = ["--plant", "TwoMassDriveline", "--fmus", str(native.parent)]
    given = ["simulate", "--manoeuvre", "tipin0", "--controller", str(blocks["controller"]), *plant]
    for quiet in (["--quiet"], []):
        warn_once.cache_clear()
        caplog.clear()
        assert main([*given, "--output", str(tmp_path / f"out{len(quiet)}"), *quiet]) == 0
        said = [text for text in caplog.messages if "the loop runs without" in text]
        assert len(said) == (0 if quiet else 1)


def test_a_block_that_does_not_fit_gets_the_command_that_maps_it(blocks: dict[str, Path], capsys: Capsys) -> None:
    assert main(["simulate", "--controller", str(blocks["plant"])]) == 2
    told = f"`driveline map {blocks['plant']} --place controller` drafts which of its variables are meant, for --map"
    assert capsys.readouterr().err.splitlines()[-1] == told


@pytest.mark.slow
@pytest.mark.parametrize("place", ["plant", "controller"])
@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_runs_with_the_smallest_block_of_a_place(
    command: str,
    place: str,
    blocks: dict[str, Path],
    native: Path,
    native_builder: Any,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capsys,
) -> None:
    for fmu in (EVERY[NO_DAMPING], SIGNAL_FAULTS):
        native_builder(fmu, native.parent)
    monkeypatch.chdir(tmp_path)
    Path("trip.csv").write_text(TRIP)
    Path("car.toml").write_text("m = 1450\n")
    car = ["--vehicle", "car.toml"] if place == "plant" and command in ("replay", "record") else []
    plant = [] if place == "plant" or command in ("record", "ssp") else ["--plant", "TwoMassDriveline"]
    plant += ["--controller", "DampingController"] if (command, place) == ("robustness", "plant") else []
    given = [command, *COMMANDS[command], *car, *plant, f"--{place}", str(blocks[place])]
    code = main([*given, "--fmus", str(native.parent), "--build", "native", "--output", str(tmp_path / "out")])
    said = capsys.readouterr()
    assert code in ((0, 1) if command == "faults" else (0,)), said.err
    assert any((tmp_path / "out").iterdir())

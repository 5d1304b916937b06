"""What the README and the docstring of the package show runs as it stands there."""

from pathlib import Path

from fmutesting.readme import run_examples

README = Path(__file__).parents[1] / "README.md"


def test_the_examples_run(tmp_path: Path, native_builder: object) -> None:
    printed = run_examples("fmublocks", README, tmp_path)
    assert "build/fmi3/PiController.fmu" in printed
    assert printed.splitlines()[-2:] == ["build/PiController.fmu", "build/native/PiController.fmu"]
    assert (tmp_path / "build/c/pi_controller.c").is_file()

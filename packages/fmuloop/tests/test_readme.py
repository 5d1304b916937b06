"""What the README and the docstring of the package show runs as it stands there."""

from pathlib import Path

from fmutesting.blocks import build
from fmutesting.readme import run_examples

README = Path(__file__).parents[1] / "README.md"


def test_the_examples_run(tmp_path: Path, native_builder: object) -> None:
    build(tmp_path, "pi_controller", "lag")
    assert "1.003 after 2 s" in run_examples("fmuloop", README, tmp_path)

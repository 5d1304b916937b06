"""What the README and the docstring of the package show runs as it stands there."""

from pathlib import Path

from fmutesting.blocks import build
from fmutesting.readme import run_examples

README = Path(__file__).parents[1] / "README.md"


def test_the_examples_run(tmp_path: Path, native_builder: object) -> None:
    build(tmp_path, "pi_controller", "lag")
    assert "rules, 0 broken" in run_examples("fmucheck", README, tmp_path)

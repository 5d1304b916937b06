"""What the README and the docstring of the package show runs as it stands there."""

import subprocess
import sys
from pathlib import Path

from fmutesting.readme import run_examples

README = Path(__file__).parents[1] / "README.md"


def test_the_examples_run(tmp_path: Path) -> None:
    printed = run_examples("toolground", README, tmp_path)
    assert "km/h" in printed
    assert (tmp_path / "gains.txt").read_text() == "0.277778"
    for words, code, out, error in (
        (["Ada", "--times", "2"], 0, "Hello Ada\nHello Ada\n", ""),
        (["Ada", "--times", "0"], 2, "", "greet: --times 0: once at least\n"),
        (["Ada", "--tims", "1"], 2, "", "did you mean --times?"),
        (["--help"], 0, "python greet.py Ada", ""),
    ):
        command = [sys.executable, "greet.py", *words]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == code
        assert out in done.stdout
        assert error in done.stderr

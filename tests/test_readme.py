"""What the README shows works."""

import re
from pathlib import Path

import pytest

from tests import ROOT

(EXAMPLE,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.S)


def test_the_lines_of_python_print_the_settling_time(both_built: Path, capsys: pytest.CaptureFixture[str]) -> None:
    exec(EXAMPLE.replace("simulate(tipin, ", f"simulate(tipin, folder=Path({str(both_built)!r}), "), {"Path": Path})
    assert 0.05 < float(capsys.readouterr().out) < 0.2

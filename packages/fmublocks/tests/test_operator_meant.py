"""A function of the user's own that does what symbols cannot is told which operator it needs."""

from pathlib import Path

import pytest

from fmublocks.native.arithmetic import Node, Recording, TracedSymbol
from fmublocks.operator_meant import operator_meant


@pytest.mark.parametrize(
    ("expression", "message"),
    [
        ("1.0 if x > 0.1 else 0.0", "`x > 0.1` is known in a run alone; call `operators.where`"),
        ("x > 0.0 and x < 1.0", "`x > 0.0 and x < 1.0` is known in a run alone; call `operators.logical_and`"),
        ("not x > 0.0 or 1.0", "`not x > 0.0` is known in a run alone; call `operators.logical_not`"),
        ("0.0 < x < 1.0", "`0.0 < x < 1.0` is known in a run alone; call `operators.logical_and`"),
        ("1.0 + max(x, 0.0)", "`max` takes numbers that are known when the FMU is built; call `operators.maximum`"),
        ("math.tanh(2.0 * x)", "`math.tanh` takes numbers that are known when the FMU is built; call `operators.tanh`"),
        ("np.arctan(x)", "`np.arctan` takes numbers that are known when the FMU is built; call `operators.atan`"),
        ("np.where(x > 0.0, x, 0.0)", "`np.where` takes numbers that are known when the FMU is built; call `operators"),
        ("math.fabs(x)", "`math.fabs` takes numbers that are known when the FMU is built; write `abs(x)`"),
        ("math.erf(x)", "`math.erf` takes numbers that are known when the FMU is built; the operators"),
        ("x + 'a'", ""),
        ("x.speed", ""),
        ("math.tanh('a')", ""),
    ],
)
def test_the_operator_that_is_meant_is_named(tmp_path: Path, expression: str, message: str) -> None:
    file = tmp_path / "own.py"
    file.write_text(f"import math\n\nimport numpy as np\n\n\ndef torque(x):\n    return {expression}\n")
    own: dict = {}
    exec(compile(file.read_text(), str(file), "exec"), own)
    recording = Recording()
    x = TracedSymbol(recording, recording.number(Node("INPUT", (), (0, 0))))
    with pytest.raises(Exception) as error:  # noqa: PT011 (of any kind)
        own["torque"](x)
    assert operator_meant(error.value).startswith(message) is True
    assert bool(operator_meant(error.value)) is bool(message)

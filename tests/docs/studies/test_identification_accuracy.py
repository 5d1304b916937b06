"""Bad data are those of the trap that is asked for, with its seed and what is wrongly taken as known."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from docs.studies import identification_accuracy
from docs.studies.identification_accuracy import DESIGN_MODEL, KNOWN, TRAPS, trapped


@dataclass
class Recorded:
    time: np.ndarray = field(default_factory=lambda: 0.002 * np.arange(100))
    T_load: np.ndarray = field(default_factory=lambda: np.arange(100.0))
    omega_1: np.ndarray = field(default_factory=lambda: np.arange(100.0))


@pytest.mark.parametrize("number", range(len(TRAPS)))
def test_a_trap_is_the_one_that_is_asked_for(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    trap, given = TRAPS[number], []

    def recording(*args: Any) -> tuple[Recorded, np.ndarray]:
        given.append(args)
        return Recorded(), np.zeros(0)

    monkeypatch.setattr(identification_accuracy, "recording", recording)
    monkeypatch.setattr(identification_accuracy, "found", lambda recorded, start: (recorded, start))
    recorded, start = trapped((number, 70 + number))  # type: ignore[misc]
    assert given == [(DESIGN_MODEL, 70 + number, trap.parameters, trap.wheels)]
    assert start.J_1 == pytest.approx(KNOWN.J_1 * trap.J_1)
    for name in ("T_load", "omega_1"):
        assert getattr(recorded, name)[50] == pytest.approx(50.0 - trap.late.get(name, 0.0) / 0.002)

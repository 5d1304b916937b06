"""The tables of docs/identification.md say what was found."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest

from docs.studies import identification_accuracy
from docs.studies.identification import (
    TRUE,
    _accuracy,
    _redesigned,
    _traps,
    accuracy_tables,
)
from docs.studies.identification_accuracy import DESIGN_MODEL, KNOWN, TRAPS, Found, Redesigned, trapped
from docs.studies.study import Cell, Table
from driveline.harness.loop.places import PLANTS

RIGHT = Found(
    values={**TRUE, "g_L": 1.0},
    deviations={name: 1e-3 * value for name, value in TRUE.items() if value},
    warnings=(),
    quality={"predicted": 95.0},
    resonance=7.9,
    seconds=6.0,
)


def with_values(**values: float) -> Found:
    return replace(RIGHT, values={**RIGHT.values, **values})


def row(table: Table, name: str) -> list[str]:
    return [name, *map(_shown, table.rows[name])]


def _shown(cell: Cell) -> str:
    return "-" if cell is None else f"{cell:g}" if isinstance(cell, float) else str(cell)


def test_accuracy_tells_rms_worst_and_the_share_within_the_interval() -> None:
    # two standard deviations off is outside of the 95 % interval, 1.9 is inside
    found = [RIGHT, with_values(J_2=0.3 * 1.002), with_values(J_2=0.3 * (1.0 - 0.0019)), RIGHT]
    assert row(_accuracy(found, found), "J_2")[2:4] == ["0.138", "0.2"]
    assert row(_accuracy(found, found), "J_2")[5] == "75"
    assert row(_accuracy(found, found), "C")[5] == "100"


@pytest.mark.parametrize(("name", "limit"), [("J_2", 0.004), ("C", 0.001), ("phi_B", 0.0035)])
def test_a_wide_start_is_right_if_every_parameter_is_nearly_that_of_the_car(name, limit, monkeypatch) -> None:
    true = TRUE[name]
    starts = [RIGHT, *(with_values(**{name: true * (1.0 + share * limit)}) for share in (0.99, -0.99, 1.01, -1.01))]
    answers = iter([[RIGHT] * 5, [RIGHT], starts])
    monkeypatch.setattr("docs.studies.identification.run_many", lambda *_args, **_named: next(answers))
    assert accuracy_tables()["count"].rows["wide starts that find the right optimum"] == (3,)


def test_a_trap_is_passed_by_the_right_answer_or_by_naming_the_cause() -> None:
    wrong = with_values(J_2=0.35)
    named = replace(wrong, warnings=("the load torque looks late: ...",))
    late = next(k for k, trap in enumerate(TRAPS) if "T_load" in trap.late)
    every = [[RIGHT, RIGHT] for _ in TRAPS]
    every[late] = [wrong, named]
    assert row(_traps(every), TRAPS[late].name)[1:] == ["0", "50", "50", "16.67 / 16.67"]
    assert row(_traps(every), TRAPS[0].name)[1:] == ["100", "-", "100", "0.00 / 0.00"]
    k = next(k for k, trap in enumerate(TRAPS) if trap.J_1 != 1.0)
    assert row(_traps([[RIGHT] for _ in TRAPS]), TRAPS[k].name)[1:4] == ["0", "0", "0"], "a wrong J_1 is to be named"


def test_redesigned_controllers_are_compared_car_by_car() -> None:
    before = {"tipin15": (0.2, 0.1), "launch": (0.2, 0.1)}
    better, worse = {"tipin15": (0.1, 0.05), "launch": (0.1, 0.05)}, {"tipin15": (0.2, 0.1), "launch": (0.22, 0.1)}
    cars = [
        Redesigned(PLANTS[0], 1, before, better, {}),
        Redesigned(PLANTS[0], 2, before, worse, {}),
        Redesigned(PLANTS[0], 3, before, {}, {}, "the motor is too slow"),
        Redesigned(PLANTS[1], 1, before, better, {}),
    ]
    cells = row(_redesigned(cars), PLANTS[0])
    assert cells[1:3] == ["3", "1"]
    assert cells[5:9] == ["50", "100", "50", "100"]
    worse["launch"] = (0.222, 0.1)
    assert row(_redesigned(cars), PLANTS[0])[8] == "50"


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

"""The tables of docs/identification.md say what was found."""

from dataclasses import replace

import pytest

from docs.studies.identification import (
    RIGHT,
    SKEW,
    _accuracy,
    _coverage,
    _traps,
    _vehicle,
    accuracy_tables,
)
from docs.studies.identification_accuracy import TRAPS, TRUE, Answer, Covered, Judged
from docs.studies.study import Cell, Table

EXACT = Answer(
    values={**TRUE, "g_L": 1.0},
    deviations={name: 1e-3 * value for name, value in TRUE.items() if value},
    warnings=(),
    quality={"omega_1": 95.0, "T_load": 90.0},
    resonance=7.9,
    seconds=6.0,
)


def with_values(**values: float) -> Answer:
    return replace(EXACT, values={**EXACT.values, **values})


def row(table: Table, name: str) -> list[str]:
    return [name, *map(_shown, table.rows[name])]


def _shown(cell: Cell) -> str:
    return "-" if cell is None else f"{cell:g}" if isinstance(cell, float) else str(cell)


def test_accuracy_tells_rms_worst_and_the_share_within_the_interval() -> None:
    # two standard deviations off is outside of the 95 % interval, 1.9 is inside
    answers = [EXACT, with_values(J_2=0.3 * 1.002), with_values(J_2=0.3 * (1.0 - 0.0019)), EXACT]
    assert row(_accuracy(answers, answers), "J_2")[1:] == ["0.138", "0.2", "0.196", "75"]
    assert row(_accuracy(answers, answers), "C")[4] == "100"


@pytest.mark.parametrize("name", RIGHT)
def test_a_wide_start_is_right_if_every_parameter_is_nearly_that_of_the_car(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    shares = (0.99, -0.99, 1.01, -1.01)
    starts = [EXACT, *(with_values(**{name: TRUE[name] * (1.0 + share * RIGHT[name])}) for share in shares)]
    answers = iter([[EXACT] * 5, [EXACT], starts])
    monkeypatch.setattr("docs.studies.identification.run_many", lambda *_args, **_named: next(answers))
    assert accuracy_tables()["count"].rows["wide starts that find the right optimum"] == (3,)


def covered(amplitude: float = 30.0, skewed: bool = False, **off: float) -> Covered:
    true = {"J_2": 0.3, "C": 100.0, "phi_B": 0.1, "late_T": 0.0, "late_L": 0.0}
    deviations = {"J_2": 0.003, "C": 0.1, "phi_B": 1e-4, "late_T": 1e-4, "late_L": 1e-4}
    bound = {name: deviation / 1.25 for name, deviation in deviations.items()}
    return Covered(amplitude, skewed, dict.fromkeys(true, 0.0) | off, true, deviations, bound)


def test_coverage_is_told_by_amplitude_and_skew_and_for_all() -> None:
    """A skew just within, an inertia outside of its interval, and one that is not right."""
    every = [covered(), covered(late_L=0.99 * SKEW), covered(15.0, True, J_2=0.0059), covered(15.0, True, J_2=0.0061)]
    table = _coverage(every)
    assert row(table, "30 N.m, aligned")[1:3] == ["2", "0.00 / 0.00"]
    assert row(table, "30 N.m, aligned")[5:] == [
        "0.14 / 0.20",
        "100",
        "100 / 100 / 100 / 100 / 50",
        "1.96",
        "1.25",
        "1.57",
    ]
    assert row(table, "15 N.m, skewed")[2] == "2.00 / 2.03"
    assert row(table, "15 N.m, skewed")[6:8] == ["50", "0 / 100 / 100 / 100 / 100"]
    assert row(table, "all, all")[1] == "4"
    assert row(table, "30 N.m, skewed")[1:] == ["0", *["-"] * 9]


def test_a_trap_is_passed_by_the_right_answer_or_by_naming_the_cause() -> None:
    wrong = with_values(J_2=0.35)
    named = replace(wrong, warnings=("load torque comes 4.0 ms late, ...",))
    late = next(k for k, trap in enumerate(TRAPS) if "T_load" in trap.late)
    every = [[EXACT, EXACT] for _ in TRAPS]
    every[late] = [wrong, named]
    assert row(_traps(every), TRAPS[late].name)[1:] == ["0", "50", "50", "16.67 / 16.67"]
    assert row(_traps(every), TRAPS[0].name)[1:] == ["100", "-", "100", "0.00 / 0.00"]


def test_a_wrong_J_1_is_only_passed_if_it_is_named() -> None:
    k = next(k for k, trap in enumerate(TRAPS) if trap.J_1 != 1.0)
    every = [[EXACT] for _ in TRAPS]
    assert row(_traps(every), TRAPS[k].name)[1:4] == ["0", "0", "0"]


def test_a_detailed_car_is_told_against_the_truth() -> None:
    one = Judged(with_values(d=0.3), 1.02, 8.0, 0.7, (1.0, 1.02))
    alone = replace(one, answer=replace(one.answer, quality={"omega_1": 80.0, "T_load": float("nan")}))
    table = _vehicle({"default": one, "no load torque": alone})
    assert row(table, "default")[1:6] == ["+2.00 +- 0.20", "-1.25", "1", "1.02", "0.7"]
    assert [row(table, name)[9:11] for name in ("default", "no load torque")] == [["95", "90"], ["80", "-"]]

"""The tables of docs/identification.md say what was found."""

from dataclasses import replace

import pytest

from docs.studies.foreign_loop import CARS, Loop
from docs.studies.identification import (
    LOOPS,
    TRUE,
    _accuracy,
    _foreign,
    _methods,
    _redesigned,
    _traps,
    _vehicle,
    accuracy_tables,
)
from docs.studies.identification_accuracy import TRAPS, Found, Judged, Method, Redesigned
from docs.studies.study import Cell, Table
from driveline.harness.identification.drive_train import Parameters
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
def test_a_wide_start_is_right_if_every_parameter_is_nearly_that_of_the_car(
    name: str, limit: float, monkeypatch: pytest.MonkeyPatch
) -> None:
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


def test_a_wrong_J_1_is_only_passed_if_it_is_named() -> None:
    k = next(k for k, trap in enumerate(TRAPS) if trap.J_1 != 1.0)
    every = [[RIGHT] for _ in TRAPS]
    assert row(_traps(every), TRAPS[k].name)[1:4] == ["0", "0", "0"]


def test_loops_that_are_not_ours_are_told_by_tyre_and_together() -> None:
    """Each car with its parameters but one, whose J_2 is 2 % too large and whose load torque is found .1 ms off."""

    def drive(
        number: int, loop: Loop, off: float = 0.0
    ) -> tuple[tuple[int, Loop, int], tuple[Found, tuple[float, float]]]:
        car = CARS[number]
        values = {"J_2": car.J_2 * (1.0 + off), "C": car.C, "phi_B": car.phi_B}
        found = replace(RIGHT, values=values, deviations={name: 0.005 * value for name, value in values.items()})
        late_T, late_L = loop.shifts
        return (number, loop, 1), (found, (late_T, late_L + 0.005 * off))

    every = [[drive(k, loop) for k in range(3)] for loop in LOOPS.values()]
    every[0][1] = drive(1, next(iter(LOOPS.values())), off=0.02)
    lines = [[*name.rsplit(", ", 1), *map(_shown, cells)] for name, cells in _foreign(every).rows.items()]
    first, spring, damper = next(iter(LOOPS)), lines[-2], lines[-1]
    assert lines[0] == [first, "spring", *["0.00 / 0.00"] * 3, "0.98", "100", "0.0 / 0.0", "0.00 / 0.00"]
    assert lines[1][:3] == [first, "damper", "2.00 / 2.00"]
    assert lines[1][5:] == ["1", "67", "0.0 / 0.0", "0.00 / 0.10"]
    assert spring[:3] == ["all", "spring", "0.00 / 0.00"]
    rms = 2.0 / len(LOOPS) ** 0.5
    assert damper == ["all", "damper", f"{rms:.2f} / 2.00", *["0.00 / 0.00"] * 2, "0.98", "96", "-", "0.00 / 0.10"]


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


def test_the_vehicle_is_told_with_and_without_load() -> None:
    one = Judged(with_values(d=0.3), (95.0, 78.0), (98.0, 94.0), (0.2, 0.7), 8.0)
    alone = replace(one, response=(float("nan"), 1.1), simulated=(93.0, 50.0))
    table = _vehicle([one, one], [alone, alone])
    assert row(table, "simulated 0.5 s: omega_1 - omega_2")[2:] == ["78", "50"]
    assert row(table, "response 2 to 12 Hz with the true load, dB rms")[2:] == ["0.2", "-"]


def test_both_methods_are_told_with_their_scatter() -> None:
    near, far = Parameters(0.055, 0.3, 117.4, 0.2, 0.157), Parameters(0.055, 0.1, 100.0, 0.1, 0.1)
    pair = (Method(near, 99.0, 2.0), Method(far, 90.0, 20.0))
    other = (Method(near._replace(C=119.4), 98.0, 4.0), Method(far, 90.0, 20.0))
    table = _methods({PLANTS[0]: [pair, other]})
    cells = [[*name.split(", "), *map(_shown, of)] for name, of in table.rows.items()]
    assert cells[0] == [
        PLANTS[0],
        "prediction error",
        "0.3 +- 0 %",
        "118.4 +- 1.2 %",
        "0.157 +- 0 %",
        "0.2",
        "98.5",
        "3",
    ]
    assert cells[1][1:] == ["output error", "0.1 +- 0 %", "100 +- 0 %", "0.1 +- 0 %", "0.1", "90", "20"]

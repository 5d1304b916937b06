"""Where the names and the numbers of a text file begin."""

from pathlib import Path

import pytest

from driverecords.dialect import Dialect, dialect_of

NAMES = ("Time", "Velocity", "Elevation", "Torque")
ROWS = "\n".join(f"{k};36.5;500;{k}" for k in range(6)) + "\n"


def dialect(above: str, rows: str = ROWS, names: tuple[str, ...] = NAMES) -> Dialect:
    return dialect_of(f"{above}{';'.join(names)}\n{rows}", Path("drive.csv"))


@pytest.mark.parametrize("short", ["100", "100;200", "100;200;;"])
def test_rows_of_half_the_usual_cells_are_no_numbers(short: str) -> None:
    """However many there are, as a preamble has: rate, date, number of the bench."""
    result = dialect(f"{short}\n{short}\n")
    assert (result.names, result.names_line, result.first_line) == (NAMES, 3, 4)


@pytest.mark.parametrize(("cells", "first"), [(2, 4), (3, 2)])
def test_rows_of_more_than_half_the_usual_cells_are_numbers(cells: int, first: int) -> None:
    """Of five, three; what follows them is no line of names any more."""
    names, row = ("Time", "A", "B", "C", "D"), "1;2;3;4;5"
    short = ";".join(row.split(";")[:cells])
    text = f"Time;A;B;C;D\n{short}\n{short}\n" + f"{row}\n" * 5
    result = dialect_of(text, Path("drive.csv"))
    assert (result.names, result.names_line, result.first_line) == (names, 1, 2), "numbers begin below the names"
    above = f"{short}\n{short}\n{';'.join(names)}\n" + f"{row}\n" * 5
    if first == 4:
        assert dialect_of(above, Path("drive.csv")).first_line == 4
    else:
        with pytest.raises(Exception, match="line 1: there is no line of names above the numbers"):
            dialect_of(above, Path("drive.csv"))


@pytest.mark.parametrize(("row", "are_numbers"), [("1;2;x;y", True), ("1;x;y;z", False)])
def test_half_of_the_cells_of_a_row_of_numbers_are_numbers(row: str, are_numbers: bool) -> None:
    rows = f"{row}\n" * 2 + ROWS
    result = dialect("", rows)
    assert result.first_line == 2, "a row with a number in it is no row of names"
    text = f"{row}\n" * 2 + f"{';'.join(NAMES)}\n{ROWS}"
    if are_numbers:
        with pytest.raises(Exception, match="there is no line of names above the numbers"):
            dialect_of(text, Path("drive.csv"))
    else:
        assert dialect_of(text, Path("drive.csv")).names == NAMES


def test_one_row_of_numbers_above_the_names_is_no_beginning() -> None:
    """As many cells as usual, but what follows is none: units of a rate, limits of an alarm."""
    assert dialect("0;40;600;200\n").names == NAMES


@pytest.mark.parametrize(
    ("units", "are_units"),
    [("s;Nm;enum", True), ("s;Nm;enum;gear", True), ("s;enum;gear;on", False), ("rpm;Nm;enum", False)],
)
def test_beside_a_time_two_thirds_of_the_units_may_be_none(units: str, are_units: bool) -> None:
    names = NAMES[: units.count(";") + 1]
    result = dialect("", f"{units}\n" + f"{';'.join('1234'[: len(names)])}\n" * 6, names)
    cells = tuple(units.split(";"))
    assert (result.names, result.units) == ((names, cells) if are_units else (cells, ())), "the last row is of names"


@pytest.mark.parametrize(
    ("speeds", "decimal"),
    [("998;1,002", "."), ("998;1.002", ","), ("1000;1,002", ","), ("998,5;1,002", ","), ("2,125;1,002", ",")],
)
def test_a_mark_before_three_digits_is_one_of_thousands_beside_whole_numbers_below(speeds: str, decimal: str) -> None:
    rows = "".join(f"{k};{speed}\n" for k, speed in enumerate(3 * speeds.split(";")))
    assert dialect("", rows, ("Time", "Speed")).decimal == decimal

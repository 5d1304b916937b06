"""The table of causes: the page has the rows that the controller runs."""

from docs.studies.causes import PAGE, causes
from docs.studies.generated_sections import filled
from driveline.models.controller.causes import FAILURES


def test_the_page_has_the_rows_of_the_controller() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert filled(page, {"causes": causes()}) == page, "python -m docs.studies.causes"


def test_a_row_says_after_how_long_it_counts() -> None:
    rows = causes().splitlines()[2:]
    assert len(rows) == len(FAILURES) + 1
    assert "`t_apart` (0.1 s)" in next(row for row in rows if "wheel_contradicts" in row)
    assert next(row for row in rows if "feeds_oscillation" in row).startswith("| 9 |")
    assert "at once" in next(row for row in rows if "wrong_launch" in row)

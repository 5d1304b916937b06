"""The page on recordings says what the declarations say."""

from docs.studies.recordings_page import page
from driveline.harness.recordings.quantities import QUANTITIES, aliases
from tests import ROOT

PAGE = (ROOT / "docs" / "recordings.md").read_text(encoding="utf-8")


def test_the_tables_are_up_to_date() -> None:
    assert page(PAGE) == PAGE, "python -m docs.studies recordings"
    assert page(PAGE.replace("| refused |", "| said |")) == PAGE


def test_every_quantity_and_every_name_is_on_it() -> None:
    assert all(f"| `{quantity}` |" in PAGE for quantity in QUANTITIES)
    assert all(f"`{name}`" in PAGE for names in aliases().values() for name in names)

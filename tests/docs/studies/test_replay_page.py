"""The tables of recorded drives are those of the command, and what is beside them stays."""

from pathlib import Path

from docs.studies.replay_page import PAGE, make


def test_the_page_has_the_tables_of_the_command_by_trips_and_plants(tmp_path: Path) -> None:
    for drive in ("b_X", "a_Y", "a_X"):
        (tmp_path / drive).mkdir()
        (tmp_path / drive / f"{drive[0]}_table.md").write_text(f"| {drive} |\n\n", encoding="utf-8")
    make(tmp_path)
    before, mark, after = PAGE.read_text(encoding="utf-8").partition("made by python -m docs.studies replay -->\n")
    made = (tmp_path / "replay.md").read_text(encoding="utf-8")
    rest = after[after.index("<!-- end -->") :]
    assert made == f"{before}{mark}| a_X |\n\n| a_Y |\n\n| b_X |\n{rest}"

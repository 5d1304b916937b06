"""The documentation page of all blocks."""

from docs.studies.blocks_page import page
from driveline.fmus.catalogue import FMUS
from driveline.fmus.description.variables import interface
from tests import ROOT


def test_the_page_in_the_repository_is_up_to_date():
    assert (ROOT / "docs" / "blocks.md").read_text(encoding="utf-8") == page(), "run `python -m docs.studies blocks`"


def test_every_variable_of_every_block_has_its_row():
    sections = page().split("\n## ")[1:]
    assert [section.partition("\n")[0] for section in sections] == list(FMUS)
    for fmu, section in zip(FMUS.values(), sections, strict=True):
        rows = [line.split(" | ")[0] for line in section.splitlines() if line.startswith("| `")]
        assert rows == [f"| `{variable.name}`" for variable in interface(fmu.block)]

"""The documentation page of all blocks."""

from docs.studies.blocks_page import PATH, blocks_page
from driveline.fmus.catalogue import FMUS
from driveline.fmus.description.variables import interface


def test_the_page_in_the_repository_is_up_to_date():
    assert PATH.read_text(encoding="utf-8") == blocks_page(), "run `python -m docs.studies.blocks_page`"


def test_every_variable_of_every_block_has_its_row():
    sections = blocks_page().split("\n## ")[1:]
    assert [section.partition("\n")[0] for section in sections] == list(FMUS)
    for fmu, section in zip(FMUS.values(), sections, strict=True):
        rows = [line.split(" | ")[0] for line in section.splitlines() if line.startswith("| `")]
        assert rows == [f"| `{variable.name}`" for variable in interface(fmu.block)]

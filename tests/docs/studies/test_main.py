"""`make docs`: makes what is stale, keeps what was made when it is stopped, and goes on there."""

import json
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

from docs.studies import __main__ as program
from docs.studies import digests
from docs.studies.identification_page import TABLES
from docs.studies.pages import PAGES, Page
from driveline.harness.commands.cli import parser


class Studies:
    """Two pages of one study, and what is made of them."""

    def __init__(self, root: Path) -> None:
        self.docs, self.results, self.made = root / "docs", root / "results", []
        self.stops = False
        (self.docs / "figures").mkdir(parents=True)
        (root / "made.json").write_text("{}", encoding="utf-8")
        (root / "stale.toml").write_text("", encoding="utf-8")
        self.data = root / "data.csv"
        self.data.write_text("1", encoding="utf-8")

    def make(self, folder: Path, name: str) -> None:
        kept = folder / "kept"
        self.made.append(f"{name} goes on" if kept.exists() else name)
        kept.touch()
        if name == "b" and self.stops:
            raise KeyboardInterrupt
        (folder / f"{name}.md").write_text(f"{self.data.read_text(encoding='utf-8')}\n", encoding="utf-8")
        (folder / f"{name}_{self.data.read_text(encoding='utf-8')}.png").touch()


@pytest.fixture
def studies(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Studies]:
    found = Studies(tmp_path)
    module = ModuleType("study_of_a_test")
    module.make = found.make  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, module.__name__, module)
    pages = {
        name: Page(
            name,
            (f"{module.__name__} {name}",),
            {f"{name}.md": f"{name}.md", f"figures/{name}_*.png": f"{name}_*.png"},
            files=("data.csv",),
        )
        for name in ("a", "b")
    }
    for module in (program, digests):
        monkeypatch.setattr(module, "ROOT", tmp_path)
    monkeypatch.setattr(program, "PAGES", pages)
    monkeypatch.setattr(program, "DOCS", found.docs)
    monkeypatch.setattr(program, "RESULTS", found.results)
    monkeypatch.setattr(digests, "MADE", tmp_path / "made.json")
    monkeypatch.setattr(digests, "STALE", tmp_path / "stale.toml")
    digests.digest.cache_clear()
    yield found
    digests.digest.cache_clear()


def changed(studies: Studies, text: str) -> None:
    studies.data.write_text(text, encoding="utf-8")
    digests.digest.cache_clear()


def test_what_is_stale_is_made_and_nothing_else(studies: Studies) -> None:
    program.main(["a"])
    program.main([])
    program.main([])
    assert studies.made == ["a", "b"]
    changed(studies, "2")
    program.main([])
    assert studies.made == ["a", "b", "a", "b"]
    assert (studies.docs / "a.md").read_text(encoding="utf-8") == "2\n"


def test_a_figure_that_is_not_made_any_more_goes(studies: Studies) -> None:
    program.main([])
    changed(studies, "2")
    program.main([])
    assert sorted(path.name for path in (studies.docs / "figures").iterdir()) == ["a_2.png", "b_2.png"]


def test_stopped_it_keeps_the_page_that_is_made_and_goes_on_with_the_next(studies: Studies) -> None:
    studies.stops = True
    with pytest.raises(KeyboardInterrupt):
        program.main([])
    assert [path.name for path in studies.docs.glob("*.md")] == ["a.md"]
    assert json.loads(digests.MADE.read_text(encoding="utf-8")).keys() == {"a"}
    studies.stops = False
    program.main([])
    assert studies.made == ["a", "b", "b goes on"]
    assert list(studies.results.iterdir()) == []


def test_what_was_begun_with_other_code_is_not_gone_on_with(studies: Studies) -> None:
    studies.stops = True
    with pytest.raises(KeyboardInterrupt):
        program.main(["b"])
    studies.stops = False
    changed(studies, "2")
    program.main(["b"])
    assert studies.made == ["b", "b"]


def test_it_says_what_it_makes_and_whether_that_came_out_the_same(
    studies: Studies, capsys: pytest.CaptureFixture[str]
) -> None:
    program.main(["a"])
    program.main(["a"])
    assert capsys.readouterr().out.splitlines() == [
        "[1/1] a",
        "[1/1] a: docs/a.md, docs/figures/a_1.png",
        "[1/1] a",
        "[1/1] a: came out the same",
    ]


def test_the_list_tells_what_is_stale_because_of_which_files(
    studies: Studies, capsys: pytest.CaptureFixture[str]
) -> None:
    program.main([])
    changed(studies, "2")
    program.main(["a"])
    digests.STALE.write_text('b = "It takes too long."\n', encoding="utf-8")
    capsys.readouterr()
    program.main(["--list"])
    assert capsys.readouterr().out == "a: up to date\nb: stale: data.csv\n    It takes too long.\n"


def test_a_page_that_is_not_in_the_table_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        program.main(["nothing"])
    assert "there is no page nothing; there are blocks, " in capsys.readouterr().err


def test_a_page_that_cannot_be_made_is_told_and_does_not_keep_the_others_from_being_made(
    studies: Studies, capsys: pytest.CaptureFixture[str]
) -> None:
    nobody = Page("nobody", ("driveline check nothing.fmu",), {"nobody.md": "nobody.md"}, files=("data.csv",))
    program.PAGES.update({"nobody": nobody, "b": program.PAGES.pop("b")})
    assert program.main([]) == 1
    assert studies.made == ["a", "b"]
    assert "[2/3] nobody: not made: driveline check nothing.fmu: exit code 2" in capsys.readouterr().out
    assert {path.name for path in studies.docs.glob("*.md")} == {"a.md", "b.md"}


def test_a_page_whose_steps_have_not_made_it_is_not_recorded(studies: Studies) -> None:
    program.PAGES["a"] = program.PAGES["a"]._replace(writes={"a.md": "other.md"})
    assert program.main(["a"]) == 1
    assert json.loads(digests.MADE.read_text(encoding="utf-8")) == {}


@pytest.mark.parametrize("page", PAGES.values(), ids=PAGES)
def test_commands_that_make_a_page_are_understood(page: Page) -> None:
    for step in page.steps:
        program_name, *arguments = shlex.split(step)
        if program_name == "driveline":
            parser().parse_args(arguments)


def test_every_table_of_the_identification_has_its_row() -> None:
    assert {name for name in PAGES if name.startswith("identification_")} == {f"identification_{n}" for n in TABLES}

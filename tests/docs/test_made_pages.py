"""The pages that are made for the site say what the code says."""

import ast
import re
from pathlib import Path

import pytest

import driveline
from docs.site import commands, links, reference
from driveline.harness.commands.cli import COMMANDS, complete_commands, parser
from tests import ROOT
from tests.docs.pages import PAGES, named, text_of
from tests.docs.test_code_blocks import options
from tests.test_rooms import modules


@pytest.mark.parametrize("name", COMMANDS)
def test_the_page_of_a_command_has_all_its_options(name: str) -> None:
    top = parser()
    complete_commands(top)
    page = commands.pages()[f"commands/{name}.md"]
    assert page.startswith(f"# driveline {name}\n")
    documented = set(re.findall(r"--[a-z-]+", " ".join(re.findall(r"^`(.*)`$", page, re.M))))
    assert documented == {option for option in options(top, name) if option.startswith("--")} - {"--help"}
    assert str(ROOT) not in page


def test_the_first_page_of_the_commands_leads_to_all() -> None:
    index = commands.pages()["commands/index.md"]
    assert all(f"({name}.md) | {text} |" in index for name, text in COMMANDS.items())


def test_the_reference_has_every_public_name_once() -> None:
    shown = re.findall(r"^::: (\S+)$", "\n".join(reference.pages().values()), re.M)
    assert sorted(shown) == [f"driveline.{name}" for name in dir(driveline)]


def test_every_group_of_the_reference_tells_what_it_is_for() -> None:
    rows = re.findall(r"^\| \[([\w ]+)\]\([\w.]+\) \|(.*?)\|", reference.pages()["reference/index.md"], re.M)
    assert len(rows) == len(list(reference.groups())) > 5
    assert not [title for title, text in rows if not text.strip()]


@pytest.mark.parametrize("room", sorted({name.rpartition(".")[0] for name in modules()} - {""}))
def test_every_room_tells_what_is_in_it(room: str) -> None:
    assert ast.get_docstring(ast.parse((ROOT / room.replace(".", "/") / "__init__.py").read_bytes()))


@pytest.mark.parametrize(
    ("link", "page", "on_the_site"),
    [
        ("docs/simulate.md", "index.md", "simulate.md"),
        ("LICENSE", "index.md", "files/LICENSE"),
        ("../README.md", "tutorial.md", "index.md"),
        ("../examples/cars/van.toml", "tutorial.md", "files/examples/cars/van.toml"),
        ("figures/loop.svg", "tutorial.md", "figures/loop.svg"),
    ],
)
def test_links_lead_to_the_place_on_the_site(link: str, page: str, on_the_site: str) -> None:
    assert links.fitted(f"see [this]({link}#part) and ![]({link})", page) == (
        f"see [this]({on_the_site}#part) and ![]({on_the_site})"
    )


def test_on_the_site_pages_are_called_by_their_titles() -> None:
    assert links.fitted("[simulate.md](simulate.md#formats)", "bus.md") == "[The loop from Python](simulate.md#formats)"
    assert links.fitted("[docs/bus.md](docs/bus.md)", "index.md") == "[The bus](bus.md)"


def test_links_to_elsewhere_stay() -> None:
    text = "[a](https://example.org/x.md) [b](#below) [c](mailto:a@b.c)"
    assert links.fitted(text, "index.md") == text


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_a_page_that_is_made_says_so_at_its_end_alone(page: Path) -> None:
    said = [number for number, line in enumerate(text_of(page).splitlines(), 1) if "do not edit" in line]
    assert said in ([], [len(text_of(page).splitlines())])

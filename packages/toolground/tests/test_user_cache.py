"""A file of the cache is taken as it was made, or made again."""

import os
from collections.abc import Callable
from pathlib import Path
from shutil import copyfile

import pytest

from toolground.user_cache import MOST_KEPT, kept

CONTENT = bytes(range(256)) * 4

DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "nothing left": lambda _: b"",
    "half of it": lambda content: content[: len(content) // 2],
    "a bit": lambda content: bytes([content[0] ^ 1]) + content[1:],
    "a byte": lambda content: content[:700] + b"x" + content[701:],
    "more": lambda content: content + b"\0",
}


@pytest.fixture
def made(tmp_path: Path) -> tuple[Path, list[Path]]:
    """A file of the cache, and where it was made."""
    return tmp_path / "cache" / "key" / "file", []


def ask(made: tuple[Path, list[Path]]) -> bytes:
    path, times = made

    def make(unfinished: Path) -> None:
        times.append(unfinished)
        unfinished.write_bytes(CONTENT)

    return kept(path, make).read_bytes()


def test_it_is_made_once(made: tuple[Path, list[Path]]) -> None:
    assert [ask(made) for _ in range(3)] == [CONTENT] * 3
    assert len(made[1]) == 1


@pytest.mark.parametrize("beside", ["", ".digest"])
@pytest.mark.parametrize("damage", DAMAGES)
def test_what_was_damaged_is_made_again(made: tuple[Path, list[Path]], damage: str, beside: str) -> None:
    ask(made)
    path = made[0].with_name(made[0].name + beside)
    path.write_bytes(DAMAGES[damage](path.read_bytes()))
    assert ask(made) == CONTENT
    assert len(made[1]) == 2
    assert ask(made) == CONTENT
    assert len(made[1]) == 2


@pytest.mark.parametrize("other", ["cache/other/file", "cache/key/other", "others/key/file"])
def test_a_valid_entry_of_another_place_is_made_again(
    made: tuple[Path, list[Path]], tmp_path: Path, other: str
) -> None:
    ask(made)
    kept(tmp_path / other, lambda unfinished: unfinished.write_bytes(b"other"))
    for ending in ("", ".digest"):
        copyfile(f"{tmp_path / other}{ending}", f"{made[0]}{ending}")
    assert ask(made) == CONTENT
    assert len(made[1]) == 2


def test_what_cannot_be_made_leaves_nothing(made: tuple[Path, list[Path]]) -> None:
    with pytest.raises(ZeroDivisionError):
        kept(made[0], lambda _: 1 // 0)
    assert list(made[0].parent.iterdir()) == []


def test_folders_that_were_used_last_are_kept(made: tuple[Path, list[Path]]) -> None:
    cache = made[0].parents[1]
    for age in range(MOST_KEPT + 5):
        (cache / str(age)).mkdir(parents=True)
        os.utime(cache / str(age), (1e9 - age, 1e9 - age))
    ask(made)
    assert {path.name for path in cache.iterdir()} == {"key", *map(str, range(MOST_KEPT - 1))}
    os.utime(made[0].parent, (1.0, 1.0))
    ask(made)
    assert made[0].parent.stat().st_mtime > 1e9

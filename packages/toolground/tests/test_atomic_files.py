"""Files are complete or absent, and as they were before where what writes several is stopped."""

import multiprocessing
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from errno import EPERM
from pathlib import Path

import pytest

from toolground.atomic_files import as_before_if_stopped, remove, unchanged_if_stopped, write_text


def files(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in folder.iterdir()}


def test_what_is_stopped_leaves_all_as_it_was(tmp_path: Path) -> None:
    """New files, files that were replaced, twice too, that were removed, and those that another process wrote."""
    before = {name: f"old {name}" for name in ("replaced", "twice", "removed", "theirs")}
    for name, text in before.items():
        write_text(text, tmp_path / name)

    @as_before_if_stopped()
    def stopped() -> None:
        for name in ("removed", "theirs", "theirs_new"):
            remove(tmp_path / name)
        for name in ("new", "replaced", "twice", "twice"):
            write_text("new", tmp_path / name)
        for name in ("theirs", "theirs_new"):
            other = multiprocessing.Process(target=write_text, args=("new", tmp_path / name))
            other.start()
            other.join()
        assert files(tmp_path)["theirs_new"] == "new"
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert files(tmp_path) == before


def test_what_threads_write_after_they_were_stopped_is_taken_back(tmp_path: Path) -> None:
    for name in ("kept.fmu", "replaced.fmu", "other.txt"):
        write_text("old", tmp_path / name)
    before = files(tmp_path)

    @unchanged_if_stopped("*.fmu", tmp_path, tmp_path / "native" / "deep")
    def stopped() -> None:
        with ThreadPoolExecutor() as pool:
            for name in ("new.fmu", "replaced.fmu", "native/deep/new.fmu"):
                pool.submit(write_text, "new", tmp_path / name)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert files(tmp_path) == before


def refused(*_: Path) -> None:
    raise OSError(EPERM, "no links here")


def test_a_file_is_there_all_the_time_in_which_it_is_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Even a process that is killed leaves the old one or the new one, on a file system that has links."""
    path, replace = tmp_path / "record.json", os.replace
    write_text("old", path)
    (tmp_path / f"record.json.{os.getpid()}.before.part").write_text("of a killed process")
    found = []

    def looked(old: Path, new: Path) -> None:
        found.append(path.read_text())
        replace(old, new)

    monkeypatch.setattr(os, "replace", looked)
    with as_before_if_stopped():
        write_text("new", path)
    assert (found, files(tmp_path)) == (["old"], {"record.json": "new"})


@pytest.mark.parametrize("link", [os.link, refused])
def test_what_is_stopped_has_the_old_file_again(
    link: Callable[[Path, Path], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    @as_before_if_stopped()
    def stopped() -> None:
        write_text("new", tmp_path / "replaced")
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "link", link)
    write_text("old", tmp_path / "replaced")
    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert files(tmp_path) == {"replaced": "old"}


def test_what_fails_leaves_what_it_wrote_before(tmp_path: Path) -> None:
    """An identification whose car no controller can be designed for."""
    write_text("old", tmp_path / "replaced")

    @as_before_if_stopped()
    def failed() -> None:
        write_text("new", tmp_path / "replaced")
        raise OSError

    with pytest.raises(OSError):  # noqa: PT011 (any)
        failed()
    assert files(tmp_path) == {"replaced": "new"}


def test_what_ends_well_leaves_what_it_wrote(tmp_path: Path) -> None:
    for name in ("replaced", "removed"):
        write_text("old", tmp_path / name)
    with as_before_if_stopped():
        remove(tmp_path / "removed")
        write_text("new", tmp_path / "replaced")
        write_text("new", tmp_path / "new")
    assert files(tmp_path) == {"replaced": "new", "new": "new"}


def test_a_link_stays_one(tmp_path: Path) -> None:
    write_text("old", tmp_path / "target")
    (tmp_path / "link").symlink_to(tmp_path / "target")

    @as_before_if_stopped()
    def stopped() -> None:
        write_text("new", tmp_path / "link")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert (tmp_path / "link").is_symlink()
    assert files(tmp_path) == {"link": "old", "target": "old"}

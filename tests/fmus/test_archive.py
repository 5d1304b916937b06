"""The file of an FMU: what it replaces."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from fmutesting.together import together

from driveline.harness.commands.cli import main
from fmublocks.archive import write_archive
from toolground.atomic_files import write_text

FILES = {"modelDescription.xml": b"<fmiModelDescription/>"}


def test_a_link_stays_one_and_its_file_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "link.fmu").symlink_to(tmp_path / "file.fmu")
    write_archive(FILES, tmp_path / "link.fmu")
    assert (tmp_path / "link.fmu").is_symlink()
    assert (tmp_path / "file.fmu").read_bytes().startswith(b"PK")
    assert len(list(tmp_path.iterdir())) == 2


def test_links_that_lead_round_in_a_circle_are_refused(tmp_path: Path) -> None:
    (tmp_path / "a.fmu").symlink_to(tmp_path / "b.fmu")
    (tmp_path / "b.fmu").symlink_to(tmp_path / "a.fmu")
    for write in (lambda path: write_archive(FILES, path), lambda path: write_text("text", path)):
        with pytest.raises(OSError, match=r"symbolic links: '.*/a\.fmu'"):
            write(tmp_path / "a.fmu")
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.skipif(os.name != "posix", reason="needs a limit on the size of files")
@together("write", [write_archive, lambda _, path: write_text("text" * 100, path)])
def test_what_does_not_fit_is_told_with_its_file_and_leaves_nothing(
    tmp_path: Path, write: Callable[[dict[str, bytes], Path], None]
) -> None:
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (50, hard))
    try:
        with pytest.raises(OSError, match=r"File too large: '.*/of_a_run'"):
            write(FILES, tmp_path / "of_a_run")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_made_with_those_above_it(tmp_path: Path) -> None:
    for _ in range(2):
        write_archive(FILES, tmp_path / "of" / "a" / "car.fmu")
    assert [path.name for path in tmp_path.rglob("*.*")] == ["car.fmu"]


def test_what_is_no_regular_file_is_not_replaced(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.fmu")
    with pytest.raises(FileExistsError, match="is no file and is not replaced"):
        write_archive(FILES, tmp_path / "pipe.fmu")
    (tmp_path / "file").touch()
    with pytest.raises(NotADirectoryError, match="file is a file; a folder is needed"):
        write_archive(FILES, tmp_path / "file" / "Car.fmu")


def test_a_file_in_the_place_of_the_folder_is_answered_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(SystemExit) as end:
        main(["build", "--output", str(tmp_path / "file")])
    assert end.value.code == 2
    assert "--output" in (message := capsys.readouterr().err)
    assert "file is a file; a folder is needed" in message

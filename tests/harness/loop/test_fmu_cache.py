"""FMUs that a run lacks are made in the user's cache, and the folder that it was given stays as it is."""

import os
import subprocess
import sys
from errno import ENOSPC
from pathlib import Path

import pytest

from driveline.fmus.catalogue import EVERY
from driveline.fmus.origin import is_stale
from driveline.harness.loop import fmu_cache
from driveline.harness.loop.fmu_cache import as_built, refreshed_copy
from driveline.harness.loop.places import BUILD
from fmublocks import origin
from fmublocks.origin import origin_of
from fmublocks.python.packaging import build
from packages.toolground.tests.test_user_cache import DAMAGES
from tests import ROOT
from toolground.errors import UserError
from toolground.user_cache import MOST_KEPT

CAN, LOOP = EVERY["WheelSpeedCan"], EVERY["MotorTorqueLoop"]


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "driveline-damping" / "fmus"


@pytest.fixture
def given(tmp_path: Path) -> Path:
    folder = tmp_path / "given"
    folder.mkdir()
    return folder


def test_what_is_missing_or_was_damaged_is_built_once_and_the_folder_is_only_read(given: Path, cache: Path) -> None:
    given.chmod(0o555)
    kept, new = refreshed_copy([CAN], given, "python")
    assert kept.parent == cache
    assert new == [kept / "WheelSpeedCan.fmu"]
    assert not is_stale(new[0])
    assert refreshed_copy([CAN], given, "python") == (kept, [])
    whole = new[0].read_bytes()
    new[0].write_bytes(DAMAGES["a byte"](whole))
    assert refreshed_copy([CAN], given, "python") == (kept, new)
    assert new[0].read_bytes() == whole
    assert list(given.iterdir()) == []


def test_what_is_up_to_date_is_taken_as_it_is(given: Path) -> None:
    path = build(CAN.started_with({"i": 12.0}), given)
    kept, new = refreshed_copy([CAN, LOOP], given, "python")
    assert new == [kept / "MotorTorqueLoop.fmu"]
    assert (kept / path.name).read_bytes() == path.read_bytes()


def test_what_is_stale_stays_the_car_that_it_was_built_as(given: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = build(CAN.started_with({"i": 12.0}), given)
    before = path.read_bytes()
    monkeypatch.setattr(origin, "sources_digest", lambda _: "others")
    kept, new = refreshed_copy([CAN], given, "python")
    found = origin_of(new[0])
    assert found is not None
    assert found.start_values == {"i": 12.0}
    assert path.read_bytes() == before
    path.unlink()
    assert refreshed_copy([CAN], given, "python")[0] != kept, "another car"


@pytest.mark.slow
def test_two_processes_at_once_build_it_once_and_nothing_unfinished_is_left(given: Path, cache: Path) -> None:
    code = (
        "from pathlib import Path; from driveline.fmus.catalogue import EVERY;"
        "from driveline.harness.loop.fmu_cache import refreshed_copy;"
        f"print(len(refreshed_copy([EVERY['WheelSpeedCan']], Path({str(given)!r}), 'python')[1]))"
    )
    both = [subprocess.Popen([sys.executable, "-c", code], cwd=ROOT, stdout=subprocess.PIPE) for _ in range(2)]
    made = [int(each.communicate(timeout=60.0)[0]) for each in both]
    assert sorted(made) == [0, 1]
    assert {path.name for path in cache.rglob("*.*")} == {"WheelSpeedCan.fmu", "WheelSpeedCan.fmu.digest"}


def test_folders_that_were_used_last_are_kept_and_one_that_is_gone_is_no_fault(given: Path, cache: Path) -> None:
    cache.mkdir(parents=True)
    (cache / "gone").symlink_to(cache / "nowhere")  # is listed and has no state, as one that is forgotten meanwhile
    for age in range(MOST_KEPT + 5):
        folder = cache / str(age)
        folder.mkdir(parents=True)
        (folder / "an.fmu").write_bytes(b"")
        os.utime(folder, (1e9 - age, 1e9 - age))
    kept, new = refreshed_copy([CAN], given, "python")
    assert new == [kept / "WheelSpeedCan.fmu"]
    assert {path.name for path in cache.iterdir()} - {"gone"} == {kept.name, *map(str, range(MOST_KEPT - 1))}


def test_a_folder_counts_as_used_before_it_is_looked_through(given: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept, _ = refreshed_copy([CAN], given, "python")
    os.utime(kept, (1e9, 1e9))
    looked: list[float] = []

    def stale(path: Path) -> bool:
        looked.append(kept.stat().st_mtime)
        return is_stale(path)

    monkeypatch.setattr(fmu_cache, "is_stale", stale)
    assert refreshed_copy([CAN], given, "python") == (kept, [])
    assert min(looked) > 1e9


def test_a_file_of_the_cache_stands_for_one_that_is_built(given: Path, cache: Path) -> None:
    assert as_built(cache / "key" / "native" / "WheelSpeedCan.fmu") == BUILD / "native" / "WheelSpeedCan.fmu"
    assert as_built(given / "WheelSpeedCan.fmu") == given / "WheelSpeedCan.fmu"
    assert BUILD == ROOT / "build", "in a checkout, wherever it is run"


def test_a_cache_that_cannot_be_written_is_named_in_a_line_with_what_moves_it(
    given: Path, cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache.parent.parent.write_text("a file where a folder would be")
    with pytest.raises(UserError) as refused:
        refreshed_copy([CAN], given, "python")
    assert str(refused.value) == (
        f"the cache {cache} cannot be written: Not a directory; "
        "the environment variable XDG_CACHE_HOME names another place"
    )
    (tmp_path / "a\n\x1b[31mb").write_text("a file where a folder would be")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "a\n\x1b[31mb"))
    with pytest.raises(
        UserError, match=r"^the cache \S+/a \[31mb/driveline-damping/fmus cannot be written: "
    ) as refused:
        refreshed_copy([CAN], given, "python")
    assert str(refused.value).isprintable()


def test_a_full_disk_of_the_cache_is_not_told_of_what_is_copied_to_it(given, cache, monkeypatch) -> None:
    def copyfile(source: Path, target: Path) -> None:
        raise OSError(ENOSPC, "No space left on device", str(source), None, str(target))

    build(CAN, given)
    monkeypatch.setattr(fmu_cache, "copyfile", copyfile)
    with pytest.raises(UserError, match=f"^the cache {cache} cannot be written: No space left on device; "):
        refreshed_copy([CAN], given, "python")


def test_what_cannot_be_read_elsewhere_is_no_fault_of_the_cache(given, cache, monkeypatch) -> None:
    def copyfile(source: Path, _: Path) -> None:
        raise PermissionError(13, "Permission denied", str(source))

    path = build(CAN, given)
    monkeypatch.setattr(fmu_cache, "copyfile", copyfile)
    with pytest.raises(PermissionError) as refused:
        refreshed_copy([CAN], given, "python")
    assert refused.value.filename == str(path)

"""What an FMU tells of its making, and what is built again for it."""

from pathlib import Path

import pytest

from driveline.fmus.building import builds as catalogue_builds
from driveline.fmus.building.builds import build_fmus, refreshed
from driveline.fmus.catalogue import FMUS
from driveline.fmus.origin import is_stale
from fmublocks import builds, origin
from fmublocks.builds import NotPossible
from fmublocks.errors import BuildError
from fmublocks.origin import origin_of
from fmublocks.python.packaging import build

NAME = "WheelSpeedCan"


@pytest.fixture
def later(monkeypatch: pytest.MonkeyPatch):
    """Makes the sources others than they were."""
    return lambda: monkeypatch.setattr(origin, "sources_digest", lambda _: "others")


def test_both_builds_tell_the_sources_that_made_them(built: Path, native: Path) -> None:
    for folder in (built, native):
        for name in FMUS:
            assert not is_stale(folder / f"{name}.fmu")


def test_what_tells_nothing_is_stale(tmp_path: Path) -> None:
    assert is_stale(tmp_path / "nothing.fmu")
    (tmp_path / "broken.fmu").write_bytes(b"PK")
    assert is_stale(tmp_path / "broken.fmu")


def test_what_is_missing_or_stale_is_built_and_nothing_else(tmp_path: Path, later) -> None:
    path = tmp_path / f"{NAME}.fmu"
    assert refreshed([NAME], tmp_path, "python") == [path]
    assert refreshed([NAME], tmp_path, "python") == []
    later()
    assert is_stale(path)
    assert refreshed([NAME], tmp_path, "python") == [path]
    assert not is_stale(path)


@pytest.mark.slow
def test_a_build_leaves_what_is_there_as_it_would_make_it(tmp_path: Path, later, monkeypatch) -> None:
    monkeypatch.delenv("CC", raising=False)

    def made_again(**files) -> bool:
        before = path.stat().st_mtime_ns
        assert list(build_fmus([NAME], tmp_path, "python", **files)) == [path]
        return path.stat().st_mtime_ns != before

    (path,) = build_fmus([NAME], tmp_path, "python")
    assert not made_again()
    (tmp_path / "car.toml").write_text("i = 12.0\n")
    assert made_again(vehicle=tmp_path / "car.toml")
    assert not made_again(vehicle=tmp_path / "car.toml")
    assert made_again()
    monkeypatch.setitem(origin.TOOLS, "python", ("numpy",))
    assert made_again()
    later()
    assert made_again()
    assert not made_again()
    monkeypatch.setenv("CC", "cc")
    assert made_again()


@pytest.mark.slow
def test_builds_side_by_side_are_those_one_after_the_other(tmp_path: Path, native: Path) -> None:
    together = list(build_fmus([], tmp_path, "native"))
    assert [path.stem for path in together] == list(FMUS)
    assert all(path.read_bytes() == (native / path.name).read_bytes() for path in together)


def test_an_fmu_stays_the_car_that_it_was_built_as(tmp_path: Path, later) -> None:
    path = build(FMUS[NAME].started_with({"i": 12.0}), tmp_path)
    later()
    assert refreshed([NAME], tmp_path, "python") == [path]
    found = origin_of(path)
    assert found is not None
    assert found.start_values == {"i": 12.0}


@pytest.mark.parametrize(("values", "message"), [({"i": -1.0}, "i = -1.0"), ({"i_gone": 1.0}, "no such parameter")])
def test_start_values_that_are_refused_now_are_named_and_the_file_is_kept(
    tmp_path: Path, later, monkeypatch: pytest.MonkeyPatch, values: dict[str, float], message: str
) -> None:
    path = build(FMUS[NAME], tmp_path)
    before = path.read_bytes()
    later()
    found = origin.Origin("older", values, frozenset())
    monkeypatch.setattr(catalogue_builds, "origin_of", lambda _: found)
    with pytest.raises(BuildError, match=message):
        refreshed([NAME], tmp_path, "python")
    assert path.read_bytes() == before


def test_native_is_not_possible_without_a_compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.raises(NotPossible, match="no-such-compiler"):
        refreshed([NAME], tmp_path, "native")


def test_a_build_says_why_native_is_left_out(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    monkeypatch.setenv("CC", "no-such-compiler")
    assert len(builds.builders(None)) == 1
    assert "no native build: there is no C compiler 'no-such-compiler'" in caplog.text


def test_a_platform_is_none_of_a_python_build(tmp_path):
    with pytest.raises(BuildError, match="--platform all is for native builds; a Python build runs wherever"):
        list(build_fmus((), tmp_path, "python", "all"))
    assert list(tmp_path.iterdir()) == []

"""`driveline target export`: the C of a controller for a car, complete, and never over that of another."""

from errno import ENOSPC
from pathlib import Path

import pytest

from driveline.harness.commands.cli import main
from tests import ROOT
from tests.harness.commands import Capsys

EXPORT = ("target", "export", "--quiet")


def exported(folder: Path, *options: str) -> int:
    return main([*EXPORT, "--output", str(folder), *options])


def test_on_a_full_disk_it_writes_all_files_or_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capsys
) -> None:
    write_text = Path.write_text

    def full(path: Path, text: str, **given: str) -> int:
        if ".c." in path.name:
            raise OSError(ENOSPC, "No space left on device")
        return write_text(path, text, **given)

    monkeypatch.setattr(Path, "write_text", full)
    assert exported(tmp_path) == 1
    source = tmp_path / "damping_controller.c"
    assert capsys.readouterr().err == f"driveline target export: {source}: No space left on device\n"
    assert list(tmp_path.iterdir()) == []


def test_it_writes_headers_and_source_with_the_car_and_its_gains(tmp_path: Path) -> None:
    gains = tmp_path / "gains.toml"
    gains.write_text("k_d = 4.0\n", encoding="utf-8")
    car = ROOT / "examples" / "cars" / "van.toml"
    assert exported(tmp_path / "c", "--vehicle", str(car), "--parameters", str(gains)) == 0
    files = {path.name: path.read_text(encoding="utf-8") for path in (tmp_path / "c").iterdir()}
    assert sorted(files) == ["controller.h", "damping_controller.c", "damping_controller.h"]
    assert not any("double" in text for text in files.values())
    for line in (".k_d = 4.0f,", ".T_max = 250.0f,", ".phi_B = 0.314f,", ".omega_w = 3.0f,"):
        assert line in files["damping_controller.c"]


@pytest.mark.parametrize(
    ("entry", "controller", "message"),
    [
        ("J_1 = 0.05", "DampingController", "line 1: J_1 does not belong here"),
        ("k_d = 1e9", "DampingController", "k_d = 1e+09"),
        ("k_gap = 0.5", "SpeedWashout", "SpeedWashout has no parameter k_gap"),
    ],
)
def test_what_does_not_belong_to_the_controller_is_refused(
    entry: str, controller: str, message: str, tmp_path: Path, capsys: Capsys
) -> None:
    gains = tmp_path / "gains.toml"
    gains.write_text(f"{entry}\n", encoding="utf-8")
    assert exported(tmp_path / "c", "--parameters", str(gains), "--controller", controller) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "c").exists()


def test_the_c_of_another_controller_stays_unless_it_is_to_be_replaced(tmp_path: Path, capsys: Capsys) -> None:
    assert exported(tmp_path) == exported(tmp_path) == 0
    before = (tmp_path / "controller.h").read_bytes()
    other = ("--controller", "SpeedWashout")
    assert exported(tmp_path, *other) == 2
    assert "controller.h is there with another content" in capsys.readouterr().err
    assert (tmp_path / "controller.h").read_bytes() == before
    assert not (tmp_path / "speed_washout.c").exists()
    assert exported(tmp_path, *other, "--replace") == 0
    assert "SpeedWashout" in (tmp_path / "controller.h").read_text(encoding="utf-8")

"""What a target build hands on, where the compiler for the target need not be."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from driveline.fmus.catalogue import FMUS
from driveline.fmus.fmu import Fmu
from driveline.fmus.native.compiler import CompilerError
from driveline.harness.exchange.target import controllers, record
from driveline.harness.exchange.target.controllers import for_car, write_image
from driveline.harness.loop.settings import Settings
from driveline.models.block.declaration import variables


def test_the_image_and_its_description_are_written_into_the_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def made(sources: Mapping[str, str], folder: Path) -> Path:
        (folder / "controller.elf").write_bytes(b"an image")
        return folder / "controller.elf"

    monkeypatch.setattr(controllers, "target_image", made)
    monkeypatch.setattr(controllers, "a2l_description", lambda fmu, path: f"{fmu.name} in {path.name}\n")
    assert write_image(for_car("DampingController"), tmp_path) == [
        tmp_path / "controller.elf",
        tmp_path / "controller.a2l",
    ]
    assert (tmp_path / "controller.elf").read_bytes() == b"an image"
    assert (tmp_path / "controller.a2l").read_text() == "DampingController in controller.elf\n"


def test_a_controller_is_compiled_with_its_start_values_but_for_what_was_set(
    native: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given: dict[str, float] = {}

    def refused(fmu: Fmu, precision: object) -> Any:
        given.update(fmu.start_values)
        raise CompilerError("no compiler")

    monkeypatch.setattr(record, "target_sources", refused)
    settings = Settings(folder=native.parent, build="native", parameters={"controller.k_d": 2.5})
    with pytest.raises(CompilerError):
        record.record(settings)
    parameters = FMUS["DampingController"].block.Parameters
    assert given == {v.name: v.start for v in variables(parameters)} | {"k_d": 2.5}

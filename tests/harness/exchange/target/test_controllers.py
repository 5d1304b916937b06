"""What a controller is compiled with, and what counts as the same torque; no compiler for the target is needed."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from driveline.fmus.catalogue import FMUS
from driveline.fmus.fmu import Fmu
from driveline.fmus.native.compiler import CompilerError
from driveline.fmus.target.link import Answer
from driveline.harness.exchange.target import controllers, record
from driveline.harness.exchange.target.comparison import compare
from driveline.harness.exchange.target.controllers import Programs, for_car, write_image
from driveline.harness.exchange.target.offline_cases import Case
from driveline.harness.loop.settings import Settings
from driveline.models.block.declaration import variables
from tests.together import together


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


CASE = Case("two samples", ("T_driver",), np.zeros((2, 1)), None, False)


class StandIn:
    """A program that demands the same torque in each sample."""

    def __init__(self, T_ref: float) -> None:
        self.answer = Answer((T_ref, 0.0), (0.0,), b"", 1, 2)

    def __enter__(self) -> "StandIn":
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def start(self, u: Any) -> Answer:
        return self.answer

    update = start


@together("T_ref, distance, margin", [(100.0, 0.011, 1.0), (-100.0, 0.0055, 0.5), (0.0, 1e-3, 1.0)])
def test_torques_may_differ_by_a_millinewton_metre_and_a_ten_thousandth(
    T_ref: float, distance: float, margin: float
) -> None:
    target: Any = StandIn(T_ref + distance)
    double: Any = StandIn(T_ref)
    programs = Programs(lambda: target, lambda: target, lambda: double, Path(), "")
    found = compare(programs, CASE, ("T_ref", "T_gear_hat"))
    assert found.margin == pytest.approx(margin)
    assert found.T_ref == pytest.approx(distance)
    assert (found.samples, found.differing, found.instructions, found.stack) == (2, 0, (1.0, 1), 2)

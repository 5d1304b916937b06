"""What a controller is compiled with, what it takes of its processor, and what counts as the same torque."""

from collections.abc import Mapping
from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fmutesting.together import together

from driveline.fmus.catalogue import CONTROLLERS, FMUS
from driveline.harness.exchange.target import controllers, costs, record
from driveline.harness.exchange.target.comparison import compare
from driveline.harness.exchange.target.controllers import Programs, for_car, write_image
from driveline.harness.exchange.target.costs import schedule
from driveline.harness.exchange.target.offline_cases import Case
from driveline.harness.loop.resolved import resolve
from driveline.harness.loop.settings import Settings
from driveline.models.controller import T_S
from fmublocks.block.declaration import variables
from fmublocks.fmu import Fmu
from fmublocks.native.compiler import CompilerError
from fmublocks.native.statements import SINGLE
from fmublocks.target.link import Answer, TargetError
from fmublocks.target.sources import target_sources


def test_the_image_and_its_description_are_written_into_the_folder(tmp_path, monkeypatch) -> None:
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


def test_a_controller_is_compiled_with_its_start_values_but_for_what_was_set(native, monkeypatch) -> None:
    given: dict[str, float] = {}

    def refused(fmu: Fmu, precision: object) -> Any:
        given.update(fmu.start_values)
        raise CompilerError("no compiler")

    monkeypatch.setattr(record, "target_sources", refused)
    settings = Settings(folder=native.parent, build="native", parameters={"controller.k_d": 2.5})
    with pytest.raises(CompilerError):
        record.record(resolve(settings))
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
def test_torques_may_differ_by_a_millinewton_metre_and_a_ten_thousandth(T_ref, distance, margin) -> None:
    target: Any = StandIn(T_ref + distance)
    double: Any = StandIn(T_ref)
    programs = Programs(lambda: target, lambda: target, lambda: double, Path(), "")
    found = compare(programs, CASE, ("T_ref", "T_gear_hat"))
    assert found.margin == pytest.approx(margin)
    assert found.T_ref == pytest.approx(distance)
    assert (found.samples, found.differing, found.instructions, found.stack) == (2, 0, (1.0, 1), 2)


CLOCK = 25e6


@pytest.fixture
def sources(target: Programs) -> dict[str, str]:
    assert target
    return target_sources(CONTROLLERS["DampingController"], SINGLE)


def with_loop_in_update(sources: dict[str, str], rounds: int) -> dict[str, str]:
    """The controller with that much more to do in every sample."""
    loop = f"for (volatile int k = 0; k < {rounds}; k++) {{}}"
    head, update, body = sources["damping_controller.c"].partition("void damping_controller_update")
    return {**sources, "damping_controller.c": head + update + body.replace("{\n", f"{{\n{loop}\n", 1)}


def test_the_sample_is_kept_and_a_controller_that_takes_longer_responds_later(sources: dict[str, str]) -> None:
    found = schedule(sources)
    assert (found.samples, found.missed) == (5000, 0)
    assert found.period == round(T_S * CLOCK)
    assert 0 < found.latency < found.response < 0.25 * found.period
    assert found.period <= found.watchdog < 2 * found.period
    usual, slower = schedule(sources), schedule(with_loop_in_update(sources, 1000))
    assert slower.missed == 0
    assert slower.response > usual.response + 2000


def test_the_watchdog_ends_one_that_takes_longer_than_a_sample(sources: dict[str, str]) -> None:
    """Its interrupt, the NMI, is a fault to this board."""
    with pytest.raises(TargetError, match="crashed: exit code 3"):
        schedule(with_loop_in_update(sources, 5000))


def test_memory_is_counted_in_numbers_of_four_bytes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two states: the old one and the next."""
    monkeypatch.setattr(costs, "_flash", lambda path: {"law.o": 100, "image.elf": 250}[path.name])
    (tmp_path / "law.su").write_text("a.c:1:f\t16\tstatic\na.c:9:g\t48\tstatic\n", encoding="utf-8")
    (tmp_path / "image.map").write_text("/lib/libm.a(lib_a-sqrt.o)\n/lib/libc.a(lib_a-memcpy.o)\n", encoding="utf-8")
    link: Any = nullcontext(SimpleNamespace(states=40, inputs=7, outputs=5, parameters=30))
    found = costs.size_of(Programs(lambda: link, lambda: link, lambda: link, tmp_path / "image.elf", "law"))
    assert found == costs.Size(100, 250, 4 * (2 * 40 + 7 + 5), 4 * 30, 48, ("memcpy", "sqrt"))

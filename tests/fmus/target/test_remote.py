"""The controller's functions on a target, which is a stand-in: what is sent there and when, and what its A2L says."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from driveline.fmus.catalogue import EVERY, FMUS
from fmublocks.description.a2l import DOUBLE, SINGLE, Item, _described
from fmublocks.description.variables import interface
from fmublocks.target import image, remote
from fmublocks.target.link import Answer
from fmublocks.target.remote import Remote

BLOCK = FMUS["DampingController"].block
P, U = BLOCK.Parameters(), BLOCK.Input()


class StandIn:
    """A link to a target that notes what it is told, and answers with a state of its own each time."""

    state: tuple[float, ...] = ()

    def __init__(self, command: object, name: str) -> None:
        self.told: list[str] = []

    def set_parameters(self, values: list[float]) -> None:
        self.told.append("parameters")

    def start(self, u: Any) -> Answer:
        return self._answer("start")

    def update(self, u: Any) -> Answer:
        return self._answer("update")

    def set_state(self, x: Any) -> Answer:
        return self._answer("state")

    def _answer(self, what: str) -> Answer:
        self.told.append(what)
        numbers = (float(len(self.told)),)
        return Answer(numbers * len(BLOCK.Output._fields), numbers * len(self.state), b"", 0, 0)


@pytest.fixture
def controller(monkeypatch: pytest.MonkeyPatch) -> Remote:
    monkeypatch.setattr(StandIn, "state", tuple(remote.numbers(BLOCK.start(U, P))))
    monkeypatch.setattr(remote, "Link", StandIn)
    return Remote(BLOCK, Path("controller.elf"))


def told(controller: Remote) -> list[str]:
    link: Any = controller._link
    found, link.told = link.told, []
    return found


def test_parameters_are_sent_before_the_first_sample_and_when_they_change(controller: Remote) -> None:
    x = controller.start(U, P)
    controller.update(x, U, P)
    assert told(controller) == ["parameters", "start", "update"]
    controller.update(x, U, P._replace(k_d=2.0))
    assert told(controller) == ["parameters", "state", "update"]


def test_a_state_that_is_there_is_not_sent_and_another_one_is(controller: Remote) -> None:
    first = controller.start(U, P)
    second = controller.update(first, U, P)
    controller.output(second, U, P)
    assert told(controller) == ["parameters", "start", "update"]
    controller.update(first, U, P)
    assert told(controller) == ["state", "update"]


def test_the_largest_number_is_that_of_single_precision() -> None:
    assert float(np.finfo(np.float32).max) == SINGLE.largest
    assert float(np.finfo(np.float64).max) == DOUBLE.largest


def test_what_has_no_bounds_is_bounded_by_the_largest_numbers_and_the_others_keep_theirs() -> None:
    found = {}
    for variable in interface(BLOCK):
        text = _described(Item(variable, 0), SINGLE).splitlines()[1]
        low, high = map(float, text.split()[-2:])
        assert low == max(variable.bounds()[0], -SINGLE.largest)
        assert high == min(variable.bounds()[1], SINGLE.largest)
        found[variable.name] = low, high
    assert found["T_driver"] == (-SINGLE.largest, SINGLE.largest)
    assert found["T_max"] == (1.0, 2000.0)


def test_a_group_has_what_can_be_turned_and_another_one_the_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(image, "symbols", lambda _: dict.fromkeys(image.A2L_RECORDS.values(), 0x20000000))
    text = image.a2l_description(EVERY["DampingController"], Path())
    for group, variability in (("Calibration", "tunable"), ("Fixed", "fixed")):
        listed = text.partition(f"/begin GROUP {group} ")[2].partition("REF_CHARACTERISTIC\n")[2].splitlines()[0]
        assert set(listed.split()) == {v.name for v in interface(BLOCK) if v.variability == variability}

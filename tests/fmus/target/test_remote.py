"""The controller's functions on a target: what is sent there, and when. The target is a stand-in."""

from pathlib import Path
from typing import Any

import pytest

from driveline.fmus.catalogue import FMUS
from driveline.fmus.target import remote
from driveline.fmus.target.link import Answer
from driveline.fmus.target.remote import Remote

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

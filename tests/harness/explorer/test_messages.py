"""What a page asks for and what it is answered, without a browser."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from driveline.harness.base.errors import DrivelineError
from driveline.harness.cosimulation.runs import kept_loaded
from driveline.harness.explorer.messages import answer_of, request_of, settings
from driveline.harness.explorer.request import Request
from driveline.harness.explorer.request_runs import Answer, RequestRunner
from driveline.harness.loop.settings import Settings

OURS, OTHER = "DampingController", "SpeedWashout"


@pytest.fixture
def runner(with_washout: Path) -> RequestRunner:
    blocks = [("TwoMassDriveline", name) for name in (OURS, OTHER)]
    return RequestRunner({each: Settings(*each, folder=with_washout, build="native") for each in blocks})


def typed(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    return name.strip(), float(value)


def sent(runner: RequestRunner, **changes: Any) -> dict[str, Any]:
    """What a page sends that has been told what it begins with, as it arrives."""
    return json.loads(json.dumps({**settings(runner, [])["request"], **changes}))


def read(message: bytes) -> tuple[dict[str, Any], np.ndarray]:
    """As the page reads an answer."""
    length = int.from_bytes(message[:4], "little")
    head = json.loads(message[4 : 4 + length])
    return head, np.frombuffer(message, "<f4", offset=4 + length).reshape(-1, head["rows"])


def answered(runner: RequestRunner, **changes: Any) -> tuple[Answer, dict[str, Any], np.ndarray]:
    with kept_loaded():
        answer = runner.answer(request_of(sent(runner, **changes), runner, typed))
    return answer, *read(answer_of(answer, runner))


def test_a_page_begins_with_the_first_plant_and_manoeuvre_and_nothing_turned(runner: RequestRunner) -> None:
    assert request_of(sent(runner), runner, typed) == Request("TwoMassDriveline", next(iter(runner.manoeuvres)))


def test_what_is_turned_and_typed_is_asked_for(runner: RequestRunner) -> None:
    request = request_of(
        sent(runner, car={"m": 1600}, gains={"k_d": 2.0}, others=[OTHER], typed="plant.J_1 = 0.06, motor.tau=0.004"),
        runner,
        typed,
    )
    assert request == Request(
        "TwoMassDriveline",
        next(iter(runner.manoeuvres)),
        others=(OTHER,),
        car={"m": 1600.0},
        gains={"k_d": 2.0},
        typed={"plant.J_1": 0.06, "motor.tau": 0.004},
    )


def test_what_a_page_of_ones_own_sends_is_kept_within_the_sliders(runner: RequestRunner) -> None:
    knobs = {knob.name: knob for knob in (*runner.car, *runner.gains)}
    changes = {"car": {"m": 1e9, "phi_B": float("nan"), "wings": 2.0}, "gains": {"k_d": -1.0}, "character": 7.0}
    request = request_of(sent(runner, **changes, others=["Nobody", OTHER]), runner, typed)
    assert request.car == {"phi_B": knobs["phi_B"].low, "m": knobs["m"].high}
    assert request.gains == {"k_d": knobs["k_d"].low}
    assert (request.character, request.others) == (1.0, (OTHER,))


@pytest.mark.parametrize("change", [{"car": 1}, {"car": None}, {"typed": 1}, {"others": 5}, {"gains": {"k_d": []}}])
def test_what_is_no_request_is_refused(runner: RequestRunner, change: dict[str, Any]) -> None:
    with pytest.raises(DrivelineError, match="what the page asks for is no request"):
        request_of(sent(runner, **change), runner, typed)


def test_the_curves_of_an_answer_are_the_signals_of_its_runs(runner: RequestRunner) -> None:
    answer, head, columns = answered(runner, others=[OTHER])
    labels = [curve["label"] for panel in head["panels"] for curve in panel["curves"]]
    assert len(columns) == 1 + len(labels) + len(head["panels"])
    curves = dict(zip(labels, columns[1:], strict=False))
    ours, other = (answer.runs[name].results for name in (OURS, OTHER))
    for found, signal in (
        (columns[0], ours["time"]),
        (columns[2], ours["plant.T_gear"]),
        (curves[f"with {OTHER}"], other["plant.T_gear"]),
        (curves["to the motor, with damping"], ours["controller.T_ref"]),
        (columns[-4], ours["plant.T_gear"]),  # of the run that can be held
        (columns[-1], ours["plant.a_body"]),
    ):
        assert np.array_equal(found, signal.astype(np.float32))


def test_without_control_there_are_no_curves_with_it_and_its_run_can_be_held(runner: RequestRunner) -> None:
    answer, head, columns = answered(runner, control=False)
    assert [[curve["label"] for curve in panel["curves"]] for panel in head["panels"]] == [
        ["without damping", "demand"],
        ["demand"],
        ["without damping"],
        ["without damping"],
    ]
    assert np.array_equal(columns[-3], answer.without.results["controller.T_ref"].astype(np.float32))
    assert [name for name, _ in head["runs"]] == ["without control"]
    assert "k_d" not in head["turnable"]


def test_a_long_run_is_sent_by_its_extremes(runner: RequestRunner) -> None:
    answer, head, columns = answered(runner, manoeuvre="drive")
    torque = answer.without.results["plant.T_gear"].astype(np.float32)
    assert head["rows"] <= 3200 < len(torque)
    assert (columns[1].min(), columns[1].max()) == (torque.min(), torque.max())


def test_what_is_typed_comes_back_so_that_it_can_be_typed_again(runner: RequestRunner) -> None:
    _, head, _ = answered(runner, typed="plant.m=2000,plant.J_1=.06")
    assert head["request"]["typed"] == "plant.m=2000.0, plant.J_1=0.06"
    assert request_of(head["request"], runner, typed).typed == {"plant.m": 2000.0, "plant.J_1": 0.06}

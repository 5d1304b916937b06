"""The page of the explorer as its models are, without a browser."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from bokeh.document import Document

from driveline.harness.explorer.request_runs import RequestRunner
from driveline.harness.explorer.view import View
from driveline.harness.loop.settings import Settings


@pytest.fixture
def runner(with_washout: Path) -> RequestRunner:
    blocks = ("TwoMassDriveline", "DampingController")
    return RequestRunner({blocks: Settings(*blocks, folder=with_washout, build="native")})


def test_there_is_nothing_to_hold_before_the_first_answer(runner: RequestRunner) -> None:
    document, worker = Document(), SimpleNamespace(ask=lambda *_: None, forget=lambda _: None)
    view: Any = View(document, runner, worker, {}, lambda text: (text, 0.0))  # pyright: ignore[reportArgumentType]
    hold: Any = document.get_model_by_name("hold")
    assert hold.disabled
    view._take(runner.answer(view._request))
    assert not hold.disabled
    hold.active = True
    table: Any = document.get_model_by_name("metrics")
    assert ">held<" in table.text

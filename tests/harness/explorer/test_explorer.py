"""`driveline explore` in a browser: a process of its own, as a user has it."""

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from http.client import HTTPConnection
from pathlib import Path
from typing import Any

import pytest

from driveline.fmus.building.parameter_files import read_parameters, read_vehicle
from driveline.harness.commands.cli import main
from driveline.harness.views.colours import BLUE, GREY, VERMILION
from tests import ROOT
from tests.browser import Browser
from tests.signals import heed_signals

PATIENCE = 60.0
"""In s, for what takes milliseconds on a machine that has nothing else to do."""


class Served:
    """An explorer that runs."""

    def __init__(self, fmus: Path, folder: Path) -> None:
        self.folder = folder
        blocks = ["--controller", "DampingController", "--controller", "SpeedWashout"]
        command = ["explore", *blocks, "--fmus", str(fmus), "--output", str(folder), "--port", "0", "--build", "native"]
        self.process = subprocess.Popen(
            [sys.executable, "-m", "driveline", *command],
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            preexec_fn=heed_signals,
        )
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        found = re.match(r"http://127\.0\.0\.1:(\d+)/ ", line)
        assert found, line
        self.port = int(found[1])

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.port}/"

    def stop(self, number: int = signal.SIGINT) -> tuple[int, str]:
        """Its exit code and what it wrote to stderr."""
        self.process.send_signal(number)
        _, errors = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode, errors


@pytest.fixture(scope="module")
def running(with_washout: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    served = Served(with_washout, tmp_path_factory.mktemp("explored"))
    try:
        yield served
        code, errors = served.stop()
        assert (code, errors) == (130, "driveline explore: stopped\n")
    finally:
        served.process.kill()


@pytest.fixture
def view(chromium: Browser, running: Served) -> Browser:
    chromium.open(running.address)
    eventually(lambda: "without control" in metrics(chromium))
    return chromium


def eventually(true: Callable[[], Any]) -> None:
    """Waits until it is."""
    end = time.monotonic() + PATIENCE
    while not true():
        assert time.monotonic() < end, "in vain"
        time.sleep(0.05)


def model(name: str) -> str:
    return f"Bokeh.documents[0].get_model_by_name({json.dumps(name)})"


def put(view: Browser, name: str, value: Any, property_: str = "value") -> None:
    """What a move of the control of that name does."""
    view.js(f"void ({model(name)}.{property_} = {json.dumps(value)})")


def metrics(view: Browser) -> str:
    return view.js(f"{model('metrics')}.text")


def status(view: Browser) -> str:
    return view.js(f"{model('status')}.text")


def test_curves_follow_a_slider_and_the_run_without_control_stays(view: Browser) -> None:
    torque = view.figure("gear torque in N·m")
    eventually(lambda: torque.pixels(BLUE) > 300)
    assert torque.pixels(GREY) > 300
    before = metrics(view)
    put(view, "k_d", 1.0)
    eventually(lambda: metrics(view) != before)
    rows = [re.findall(r"<td[^>]*>([^<]*)</td>", line) for line in metrics(view).split("<tr>")]
    earlier = [re.findall(r"<td[^>]*>([^<]*)</td>", line) for line in before.split("<tr>")]
    assert rows[2] == earlier[2]  # without control
    assert float(rows[3][2]) > 2.0 * float(earlier[3][2])  # overshoot with half of the damping
    assert not [line for line in view.console() if "ERROR" in line]


def test_a_slider_can_be_dragged(view: Browser) -> None:
    before = metrics(view)
    handle = view.js(
        "(() => { const view = [...Bokeh.index.query((view) => view.model.name === 'phi_B')][0];"
        " const r = view.shadow_el.querySelector('.noUi-handle').getBoundingClientRect();"
        " return [r.left + r.width / 2, r.top + r.height / 2] })()"
    )
    view.drag((handle[0], handle[1]), (handle[0] + 60, handle[1]))
    eventually(lambda: metrics(view) != before)
    assert view.js(f"{model('phi_B')}.value") > 0.2


def test_control_can_be_switched_off_and_others_stand_beside(view: Browser) -> None:
    torque = view.figure("gear torque in N·m")
    put(view, "control", False, "active")
    eventually(lambda: "DampingController" not in metrics(view))
    view.painted()
    eventually(lambda: torque.pixels(BLUE) == 0)
    put(view, "others", [0], "active")
    eventually(lambda: "SpeedWashout" in metrics(view))
    eventually(lambda: torque.pixels(VERMILION) > 100)


def test_plant_and_manoeuvre_are_chosen(view: Browser) -> None:
    before = metrics(view)
    put(view, "plant", "ValidationVehicle")
    eventually(lambda: metrics(view) != before)
    put(view, "manoeuvre", "creep")
    eventually(lambda: view.figure("gear torque in N·m").x() == (0.0, 12.0))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("plant.m=10", "takes 300 to 10000 kg"),
        ("plant.mass=1000", "there is no parameter plant.mass"),
        ("heavy", "is not of the form"),
        ("plant.m=nan", "a parameter is a finite number"),
        ("<img src=x onerror=alert(1)>=1", "&lt;img"),
    ],
)
def test_a_bad_value_is_told_and_the_next_good_one_runs(view: Browser, text: str, message: str) -> None:
    put(view, "more", text)
    eventually(lambda: message in status(view))
    before = metrics(view)
    put(view, "more", "plant.m=3000")
    eventually(lambda: metrics(view) != before)
    assert status(view) == ""


def test_what_a_page_of_ones_own_sends_is_kept_within_the_slider(view: Browser) -> None:
    before = metrics(view)
    put(view, "m", 1e9)
    eventually(lambda: metrics(view) != before)
    assert "takes" not in status(view)


def test_two_tabs_do_not_see_each_other_and_one_that_vanishes_disturbs_nobody(view: Browser, running: Served) -> None:
    first, before = view.chrome.current_window_handle, metrics(view)
    view.chrome.switch_to.new_window("tab")
    view.open(running.address)
    eventually(lambda: metrics(view) == before)
    for k in range(20):
        put(view, "k_d", 1.0 + 0.05 * k)
    view.chrome.close()
    view.chrome.switch_to.window(first)
    assert metrics(view) == before
    put(view, "k_d", 1.0)
    eventually(lambda: metrics(view) != before)
    assert running.process.poll() is None


def test_clicks_save_the_car_the_gains_and_a_report(view: Browser, running: Served) -> None:
    put(view, "phi_B", 0.3)
    put(view, "k_d", 2.0)
    press(view, "save car and gains")
    eventually(lambda: "gains_1.toml" in status(view))
    assert read_vehicle(running.folder / "car_1.toml") == {"phi_B": 0.3}
    assert read_parameters(running.folder / "gains_1.toml")["k_d"] == 2.0
    press(view, "save report")
    eventually(lambda: "report_1.html" in status(view))
    view.open((running.folder / "report_1.html").as_uri())
    assert view.figure("gear torque in N·m").pixels(BLUE) > 300


def press(view: Browser, name: str) -> None:
    box = view.js(
        "(() => { const view = [...Bokeh.index.query((view) => view.model.name === arguments[0])][0];"
        " view.el.scrollIntoView({block: 'center'}); const r = view.el.getBoundingClientRect();"
        " return [r.left + r.width / 2, r.top + r.height / 2] })()",
        name,
    )
    view.click(tuple(box))


def test_only_this_machine_is_answered_and_no_page_of_another_origin(running: Served) -> None:
    with socket.create_connection(("127.0.0.1", running.port), 10.0):
        pass
    with (
        pytest.raises(OSError, match=r"refused|reachable"),
        socket.create_connection(("127.0.0.2", running.port), 10.0),
    ):
        pass
    connection = HTTPConnection("127.0.0.1", running.port, timeout=10.0)
    upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13"}
    connection.request(
        "GET", "/ws", headers={**upgrade, "Sec-WebSocket-Key": "a" * 24, "Origin": "http://evil.example"}
    )
    assert connection.getresponse().status == 403


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_stop_leaves_no_process_and_no_traceback(with_washout: Path, tmp_path: Path, number: int) -> None:
    served = Served(with_washout, tmp_path)
    group = os.getpgid(served.process.pid)
    code, errors = served.stop(number)
    assert (code, errors) == (128 + number, "driveline explore: stopped\n")
    with pytest.raises(ProcessLookupError):
        os.killpg(group, 0)


def test_a_port_that_is_taken_is_told_in_one_line(both_built: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        blocks = ["--controller", "DampingController", "--fmus", str(both_built)]
        assert main(["explore", *blocks, "--port", port]) == 2
    error = capsys.readouterr().err
    assert error == f"driveline explore: port {port} cannot be used (Address already in use); choose another --port\n"

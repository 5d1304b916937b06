"""`driveline explore` in a browser: a process of its own, as a user has it."""

import json
import re
import socket
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from driveline.fmus.building.parameter_files import read_parameters, read_vehicle
from driveline.harness.commands.cli import main
from driveline.harness.explorer.view import HELD_COLOR
from driveline.harness.views.colours import BLUE, GREY, VERMILION
from tests.browser import Browser
from tests.harness.explorer.served import PATIENCE, Served


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


@pytest.mark.slow
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


@pytest.mark.slow
def test_plant_and_manoeuvre_are_chosen(view: Browser) -> None:
    before = metrics(view)
    put(view, "plant", "ValidationVehicle")
    eventually(lambda: metrics(view) != before)
    put(view, "manoeuvre", "creep")
    eventually(lambda: view.figure("gear torque in N·m").x() == (0.0, 12.0))


def test_a_refused_value_goes_back_and_freezes_nothing(view: Browser) -> None:
    for text, message in (
        ("plant.J_1=-5", "plant.J_1 = -5: "),
        ("plant.m=10", "takes 300 to 40000 kg"),
        ("plant.mass=1000", "there is no parameter plant.mass"),
        ("heavy", "is not of the form"),
        ("plant.m=nan", "a parameter is a finite number"),
        ("<img src=x onerror=alert(1)>=1", "&lt;img"),
    ):
        put(view, "more", text)
        eventually(lambda message=message: message in status(view))
        assert status(view).endswith("; what was set before stays</span>")
        eventually(lambda: view.js(f"{model('more')}.value") == "")
    before = metrics(view)
    put(view, "k_d", 1.0)
    eventually(lambda: metrics(view) != before)
    assert status(view) == ""
    put(view, "more", "plant.m=3000, plant.c_slip=100000")
    eventually(lambda: view.js(f"{model('more')}.value") == "plant.m=3000.0, plant.c_slip=100000.0")
    put(view, "more", "plant.m=0")
    eventually(lambda: view.js(f"{model('more')}.value") == "plant.m=3000.0, plant.c_slip=100000.0")


def test_what_is_at_work_is_said(view: Browser) -> None:
    view.js(
        f"void (window.said = [], {model('status')}.properties.text.change.connect("
        f"() => window.said.push({model('status')}.text)))"
    )
    put(view, "manoeuvre", "drive")
    eventually(lambda: view.js("window.said.length") >= 2)
    assert view.js("window.said") == ["running ...", ""]


def test_a_knob_that_changes_nothing_cannot_be_turned(view: Browser) -> None:
    assert view.js(f"[{model('phi_B')}.disabled, {model('k_d')}.disabled]") == [False, False]
    put(view, "control", False, "active")
    eventually(lambda: view.js(f"{model('k_d')}.disabled && {model('character')}.disabled"))
    assert not view.js(f"{model('phi_B')}.disabled")


def test_a_run_that_is_held_stays_beside_those_that_follow(view: Browser) -> None:
    torque = view.figure("gear torque in N·m")
    assert ">held<" not in metrics(view)
    before = row(metrics(view), "DampingController")
    put(view, "hold", True, "active")
    eventually(lambda: ">held<" in metrics(view))
    put(view, "k_d", 0.6)
    eventually(lambda: row(metrics(view), "DampingController") != before)
    assert row(metrics(view), "held") == before
    eventually(lambda: torque.pixels(HELD_COLOR) > 100)
    put(view, "manoeuvre", "creep")
    eventually(lambda: ">held<" not in metrics(view))
    put(view, "manoeuvre", "tipin15")
    eventually(lambda: ">held<" in metrics(view))
    put(view, "hold", False, "active")
    eventually(lambda: ">held<" not in metrics(view))
    eventually(lambda: not torque.js("model.above.find((each) => each.type === 'Legend').items[0].visible"))


def row(table: str, name: str) -> list[str]:
    """The cells of a run."""
    (line,) = [line for line in table.split("<tr>") if f">{name}<" in line]
    return re.findall(r"<td[^>]*>([^<]*)</td>", line)[1:]


def test_every_knob_is_in_view_beside_the_curves_on_a_small_screen(view: Browser) -> None:
    size = {"width": 1440, "height": 900, "deviceScaleFactor": 1, "mobile": False}
    view.chrome.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        for scrolled in (0, 10_000):
            view.js(f"window.scrollTo(0, {scrolled})")
            view.painted()
            for name in ("phi_B", "d_max", "k_d", "t_return", "more", "save report", "status"):
                found = view.js(
                    "(() => { const view = [...Bokeh.index.query((view) => view.model.name === arguments[0])][0];"
                    " const r = view.el.getBoundingClientRect(); return [r.left, r.top, r.right, r.bottom] })()",
                    name,
                )
                assert 0 <= found[0] < found[2] <= (1440 if name == "status" else 480), (name, found)
                assert 0 <= found[1] < found[3] <= 900, (name, found)
        assert view.js("document.documentElement.scrollWidth") <= 1440
    finally:
        view.chrome.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_what_a_page_of_ones_own_sends_is_kept_within_the_slider(view: Browser) -> None:
    before = metrics(view)
    put(view, "m", 1e9)
    eventually(lambda: metrics(view) != before)
    assert "takes" not in status(view)


@pytest.mark.slow
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


@pytest.mark.slow
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


def test_a_port_that_is_taken_is_told_in_one_line(both_built: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        blocks = ["--controller", "DampingController", "--fmus", str(both_built)]
        assert main(["explore", *blocks, "--port", port]) == 2
    error = capsys.readouterr().err
    assert error == f"driveline explore: port {port} cannot be used (Address already in use); choose another --port\n"

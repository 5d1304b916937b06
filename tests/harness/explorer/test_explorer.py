"""`driveline explore` in a browser: a process of its own, as a user has it."""

import json
import socket
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from driveline.fmus.building.parameter_files import read_parameters, read_vehicle
from driveline.harness.commands.cli import main
from driveline.harness.explorer.messages import HELD_COLOR
from driveline.harness.views.colours import BLUE, GREY, VERMILION
from tests.browser import Browser
from tests.harness.explorer.served import DRAWN, PATIENCE, Served


@pytest.fixture
def view(chromium: Browser, running: Served) -> Browser:
    chromium.open(running.address, DRAWN)
    return chromium


def eventually(true: Callable[[], Any]) -> None:
    """Waits until it is."""
    end = time.monotonic() + PATIENCE
    while not true():
        assert time.monotonic() < end, "in vain"
        time.sleep(0.05)


def element(name: str) -> str:
    return f"document.getElementById({json.dumps(name)})"


def put(view: Browser, name: str, value: Any) -> None:
    """What a move of the control of that name does."""
    kind, event = ("checked", "change") if isinstance(value, bool) else ("value", "change")
    if isinstance(value, float):
        event = "input"
    view.js(f"void ({element(name)}.{kind} = {json.dumps(value)}, {element(name)}.dispatchEvent(new Event('{event}')))")


def metrics(view: Browser) -> dict[str, list[str]]:
    """The cells of each run."""
    rows = view.js(f"[...{element('metrics')}.rows].slice(1).map((row) => [...row.cells].map((c) => c.textContent))")
    return {name: cells for name, *cells in rows}


def status(view: Browser) -> str:
    return view.js(f"{element('status')}.textContent")


def box(view: Browser, name: str, within: str = "") -> list[float]:
    """Left, top, right and bottom of an element in the window."""
    found = f"{element(name)}{f'.querySelector({json.dumps(within)})' if within else ''}"
    return view.js(f"(({{left, top, right, bottom}}) => [left, top, right, bottom])({found}.getBoundingClientRect())")


def pixels(view: Browser, colour: str) -> int:
    """How many of the gear torque are of a colour."""
    view.js("window.scrollTo(0, 0)")
    view.painted()
    return view.pixels(box(view, "figure 0", ".u-over"), colour)


def middle(found: list[float]) -> tuple[float, float]:
    return (found[0] + found[2]) / 2, (found[1] + found[3]) / 2


def test_curves_follow_a_slider_and_the_run_without_control_stays(view: Browser, running: Served) -> None:
    eventually(lambda: pixels(view, BLUE) > 300)
    assert pixels(view, GREY) > 300
    before = metrics(view)
    put(view, "k_d", 1.0)
    eventually(lambda: metrics(view) != before)
    now = metrics(view)
    assert now["without control"] == before["without control"]
    assert float(now["DampingController"][1]) > 2.0 * float(before["DampingController"][1])  # overshoot
    assert view.console() == []
    assert all(address.startswith(running.address) for address in view.fetched())


@pytest.mark.slow
def test_a_slider_can_be_dragged(view: Browser) -> None:
    before = metrics(view)
    left, top, right, bottom = box(view, "phi_B")
    view.drag((left + 0.3 * (right - left), (top + bottom) / 2), (left + 0.5 * (right - left), (top + bottom) / 2))
    eventually(lambda: metrics(view) != before)
    assert view.js("wanted.car.phi_B") > 0.2


def test_control_can_be_switched_off_and_others_stand_beside(view: Browser) -> None:
    put(view, "control", False)
    eventually(lambda: "DampingController" not in metrics(view))
    eventually(lambda: pixels(view, BLUE) == 0)
    put(view, "SpeedWashout", True)
    eventually(lambda: "SpeedWashout" in metrics(view))
    eventually(lambda: pixels(view, VERMILION) > 100)


@pytest.mark.slow
def test_plant_and_manoeuvre_are_chosen(view: Browser) -> None:
    before = metrics(view)
    put(view, "plant", "ValidationVehicle")
    eventually(lambda: metrics(view) != before)
    put(view, "manoeuvre", "creep")
    eventually(lambda: spans(view) == [[0.0, 12.0]] * 4)


def spans(view: Browser) -> list[list[float]]:
    """From when to when each figure shows."""
    return view.js("plots.map((u) => [u.scales.x.min, u.scales.x.max])")


def test_all_figures_are_zoomed_together_and_back(view: Browser) -> None:
    whole = spans(view)
    left, top, right, bottom = box(view, "figure 1", ".u-over")
    y = (top + bottom) / 2
    view.drag((left + 0.25 * (right - left), y), (left + 0.5 * (right - left), y))
    eventually(lambda: spans(view) != whole)
    zoomed = spans(view)
    width = whole[0][1] - whole[0][0]
    assert zoomed[0] == pytest.approx([whole[0][0] + 0.25 * width, whole[0][0] + 0.5 * width], abs=0.02)
    assert zoomed == [zoomed[0]] * 4
    before = metrics(view)
    put(view, "k_d", 1.0)
    eventually(lambda: metrics(view) != before)
    assert spans(view) == zoomed
    view.js("void plots[2].over.dispatchEvent(new MouseEvent('dblclick', {bubbles: true}))")
    eventually(lambda: spans(view) == whole)


def test_a_click_on_a_name_hides_a_curve_until_it_is_shown_again(view: Browser) -> None:
    eventually(lambda: pixels(view, GREY) > 300)
    grey = middle(
        view.js(
            "(({left, top, right, bottom}) => [left, top, right, bottom])("
            "document.querySelectorAll('.u-legend .u-series')[1].getBoundingClientRect())"
        )
    )
    view.click(grey)
    eventually(lambda: pixels(view, GREY) < 30)
    put(view, "SpeedWashout", True)
    eventually(lambda: pixels(view, VERMILION) > 100)
    assert pixels(view, GREY) < 30


def test_a_refused_value_goes_back_and_freezes_nothing(view: Browser) -> None:
    def typed() -> str:
        return view.js(f"{element('typed')}.value")

    for text, message in (
        ("plant.J_1=-5", "plant.J_1 = -5: "),
        ("plant.m=10", "takes 300 to 40000 kg"),
        ("plant.mass=1000", "there is no parameter plant.mass"),
        ("heavy", "is not of the form"),
        ("plant.m=nan", "a parameter is a finite number"),
        ("<img src=x onerror=alert(1)>=1", "<img"),
    ):
        put(view, "typed", text)
        eventually(lambda message=message: message in status(view))
        assert status(view).endswith("; what was set before stays")
        assert typed() == ""
    before = metrics(view)
    put(view, "k_d", 1.0)
    eventually(lambda: metrics(view) != before)
    assert status(view) == ""
    put(view, "typed", "plant.m=3000, plant.c_slip=100000")
    eventually(lambda: typed() == "plant.m=3000.0, plant.c_slip=100000.0")
    put(view, "typed", "plant.m=0")
    eventually(lambda: typed() == "plant.m=3000.0, plant.c_slip=100000.0")


def test_what_is_at_work_is_said(view: Browser) -> None:
    view.js(
        "void (window.said = [], new MutationObserver(() => window.said.push("
        f"{element('status')}.textContent)).observe({element('status')}, {{childList: true}}))"
    )
    put(view, "manoeuvre", "drive")
    eventually(lambda: view.js("window.said.length") >= 2)
    assert view.js("window.said") == ["running ...", ""]


def test_of_what_is_moved_while_a_run_is_under_way_the_latest_counts(view: Browser) -> None:
    view.js(
        "void (window.asked = [], window.before = fetch, window.fetch = (...given) => {"
        " window.asked.push(JSON.parse(given[1].body).request.gains.k_d); return window.before(...given) })"
    )
    for k in range(20):
        put(view, "k_d", 1.0 + 0.05 * k)
    eventually(lambda: view.js("shown.request.gains.k_d") == 1.95)
    assert view.js("[window.asked[0], window.asked.at(-1), window.asked.length < 20]") == [1.0, 1.95, True]


def test_a_knob_that_changes_nothing_cannot_be_turned(view: Browser) -> None:
    assert view.js("[sliders.phi_B.disabled, sliders.k_d.disabled]") == [False, False]
    put(view, "control", False)
    eventually(lambda: view.js("sliders.k_d.disabled && sliders.character.disabled"))
    assert not view.js("sliders.phi_B.disabled")


def test_a_run_that_is_held_stays_beside_those_that_follow(view: Browser) -> None:
    assert "held" not in metrics(view)
    before = metrics(view)["DampingController"]
    press(view, "hold")
    assert metrics(view)["held"] == before
    put(view, "k_d", 0.6)
    eventually(lambda: metrics(view)["DampingController"] != before)
    assert metrics(view)["held"] == before
    eventually(lambda: pixels(view, HELD_COLOR) > 100)
    assert first_curves(view) == ["held"] * 4
    put(view, "manoeuvre", "creep")
    eventually(lambda: "held" not in metrics(view))
    put(view, "manoeuvre", "tipin15")
    eventually(lambda: "held" in metrics(view))
    press(view, "hold")
    assert "held" not in metrics(view)
    assert "held" not in first_curves(view)


def first_curves(view: Browser) -> list[str]:
    """Their names, of each figure."""
    return view.js("plots.map((u) => u.series[1].label)")


def test_every_knob_is_in_view_beside_the_curves_on_a_small_screen(view: Browser) -> None:
    size = {"width": 1440, "height": 900, "deviceScaleFactor": 1, "mobile": False}
    view.chrome.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        for scrolled in (0, 10_000):
            view.js(f"window.scrollTo(0, {scrolled})")
            view.painted()
            for name in ("phi_B", "d_max", "k_d", "t_return", "typed", "save report", "status"):
                found = box(view, name)
                assert 0 <= found[0] < found[2] <= (1440 if name == "status" else 480), (name, found)
                assert 0 <= found[1] < found[3] <= 900, (name, found)
        assert view.js("document.documentElement.scrollWidth") <= 1440
    finally:
        view.chrome.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


@pytest.mark.slow
def test_two_tabs_do_not_see_each_other_and_one_that_vanishes_disturbs_nobody(view: Browser, running: Served) -> None:
    first, before = view.chrome.current_window_handle, metrics(view)
    view.chrome.switch_to.new_window("tab")
    view.open(running.address, DRAWN)
    assert metrics(view) == before
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
    view.click(middle(box(view, name)))


def test_a_port_that_is_taken_is_told_in_one_line(both_built: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        blocks = ["--controller", "DampingController", "--fmus", str(both_built)]
        assert main(["explore", *blocks, "--port", port]) == 2
    error = capsys.readouterr().err
    assert error == f"driveline explore: port {port} cannot be used (Address already in use); choose another --port\n"

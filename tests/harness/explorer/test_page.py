"""The page of `driveline explore`: the file, what its settings mean, and what a user sees in a browser."""

import json
import re
from base64 import b64decode
from collections.abc import Iterator
from gzip import decompress as gunzip
from pathlib import Path
from shutil import copyfile
from typing import Any

import numpy as np
import pytest

from driveline.fmus.building.builds import build_fmus
from driveline.fmus.building.parameter_files import read_parameters, read_vehicle
from driveline.harness.commands import explore
from driveline.harness.commands.cli import main
from driveline.harness.commands.settings import all_loops
from driveline.harness.explorer import module
from driveline.harness.explorer.content import content
from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.resolved import as_given, resolve_all
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.demand_shape import step_of
from driveline.harness.manoeuvres.parts import points
from driveline.harness.metrics.evaluate import at_samples, evaluate
from driveline.harness.simulation.simulate import simulate
from driveline.harness.views.colours import BLUE, GREY
from tests import ROOT
from tests.browser import Browser
from tests.harness.commands import answer as answered
from tests.harness.explorer.made import column, in_node, loops

LARGEST = 600_000
"""Bytes of the page without a recording."""

DESIGN, VEHICLE = PLANTS
OURS, WASHOUT = "DampingController", "SpeedWashout"


@pytest.fixture(scope="module")
def data(native: Path, native_builder: Any) -> dict[str, Any]:
    from driveline.fmus.catalogue import EVERY

    loops()
    native_builder(EVERY[WASHOUT], native.parent)
    args = explore.Arguments(fmus=native.parent, build="native")
    return content(all_loops(args, (), (OURS, WASHOUT)))


@pytest.fixture(scope="module")
def page(native: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    loops()
    path = tmp_path_factory.mktemp("explored") / "page.html"
    words = ["--controller", OURS, "--fmus", str(native.parent), "--build", "native"]
    for _ in range(2):  # the second takes the place of the first
        assert main(["explore", *words, "--output", str(path), "--no-browser", "--quiet"]) == 0
    return path


def asked(folder: Path, data: dict[str, Any], *questions: dict[str, Any], demands: Any = ()) -> Any:
    """What the worker answers to settings; `controller` is ours unless it is among them."""
    every = [
        {"wanted": {"plant": DESIGN, "manoeuvre": "tipin15"} | each, "controller": each.pop("controller", OURS)}
        for each in questions
    ]
    return in_node("answers.js", folder, {"data": data, "questions": every, "demands": list(demands)})


def test_settings_become_the_parameters_of_the_run(data: dict[str, Any], native: Path, tmp_path: Path) -> None:
    turned = {"car": {"phi_B": 0.1, "m": 1800.0}, "gains": {"k_d": 2.0}, "typed": "motor.tau=0.004"}
    asked(tmp_path, data, turned | {}, turned | {"informed": False}, turned | {"controller": None})
    car = {"phi_B": 0.1, "m": 1800.0}
    of_plant = {f"plant.{name}": value for name, value in car.items()} | {"motor.tau": 0.004}
    known = {"controller.k_d": 2.0, "controller.phi_B": 0.1}
    with_m = known | ({"controller.m": 1800.0} if "m" in data["loops"]["fmus"][OURS]["parameters"] else {})
    for k, (more, control) in enumerate(((with_m, True), ({"controller.k_d": 2.0}, True), (with_m, False))):
        results = simulate(
            MANOEUVRES["tipin15"],
            DESIGN,
            parameters=of_plant | more,
            control=control,
            folder=native.parent,
            build="native",
        )
        assert column(tmp_path, k, "plant.T_gear") == pytest.approx(at_samples(results)["plant.T_gear"], abs=1e-7), k


def test_the_metrics_take_the_band_of_the_car(data: dict[str, Any], native: Path, tmp_path: Path) -> None:
    car = {"C": 30.0, "J_2": 1.5}
    asking = asked(tmp_path, data, {"car": car}, {"car": car, "plant": VEHICLE}, {})["answers"]
    vehicle = tmp_path / "car.toml"
    vehicle.write_text("C = 30.0\nJ_2 = 1.5\n")
    for answer, plant, file in ((asking[0], DESIGN, vehicle), (asking[1], VEHICLE, vehicle), (asking[2], DESIGN, None)):
        settings = {(plant, OURS): Settings(plant, folder=native.parent, build="native")}
        (given,) = resolve_all(settings, file).values()
        expected = evaluate(simulate(MANOEUVRES["tipin15"], given), MANOEUVRES["tipin15"])
        for name in ("gear_torque_rms", "jerk_rms"):
            assert answer["worth"][name] == pytest.approx(getattr(expected, name), rel=1e-5), (plant, file, name)


@pytest.mark.parametrize("plant", PLANTS)
def test_the_sliders_of_fmus_built_for_a_car_begin_at_that_car(plant: str, tmp_path: Path) -> None:
    loops()
    vehicle = ROOT / "examples" / "cars" / "van.toml"
    list(build_fmus([plant, "MotorTorqueLoop", "WheelSpeedCan", OURS], tmp_path, "native", vehicle=vehicle))
    page, van = content({(plant, OURS): as_given(plant, folder=tmp_path, build="native")}), read_vehicle(vehicle)
    of_plant = van.keys() & page["loops"]["fmus"][plant]["parameters"].keys()
    assert {name: page["files"]["car"].get(name) for name in of_plant} == {name: van[name] for name in of_plant}
    assert of_plant > {"m", "r", "i", "phi_B", "c_slip"}


def test_what_cannot_be_is_refused_and_what_is_the_same_is_not_run_again(data: dict[str, Any], tmp_path: Path) -> None:
    same = [{"controller": None}, {"controller": None, "gains": {"k_d": 1.0}}, {"controller": None, "car": {"m": 1e3}}]
    too_stiff = {"plant": VEHICLE, "car": {"C": 230.0, "c_slip": 72000.0}}
    answers = asked(tmp_path, data, *same, too_stiff)["answers"]
    assert [each.get("same") for each in answers[:3]] == [False, True, False]
    assert "that of ValidationVehicle can be" in answers[3]["refused"]


def test_what_is_typed_is_answered_as_set_is(
    data: dict[str, Any],
    native: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Its last step begins at 5.999 s."""
    typed = [
        *("controller.k_d=-1", "plant.k_q=1", "plane.m=1", "k_d=1", "plant.m=much", "plant.m=1e999"),
        *("controller.k_d@soon=1", "controller.k_d@5.9991=1", "plant.v_0@1=5", "plant.mu=0.5"),
        *("plant.m=1500, plant.m=1600", "controller.k_d@1=1, controller.k_d@1.0=2"),
        *("plant.m=0x5DC", "plant.m=inf", "plant.T_0=100", "controller.k_d@5.999=1"),
    ]
    answers = asked(tmp_path, data, *({"typed": text} for text in typed))["answers"]
    where = ["--fmus", str(native.parent), "--build", "native", "--output", str(tmp_path)]
    for text, answer in zip(typed, answers, strict=True):
        said = [answer["refused"]] if "refused" in answer else answer["warnings"]
        words = [word for each in text.split(", ") for word in ("--set", each)]
        caplog.clear()
        code, _, error = answered(capsys, "simulate", *words, *where, "--replace")
        assert code == (2 if "refused" in answer else 0), text
        error = re.sub(r"--plant |(?<=1[56]00)\.0", "", error + caplog.text)
        assert all(line in error for line in said), (text, error)
        assert bool(said) == (text != typed[-1])


def test_what_is_typed_goes_before_a_slider_and_both_are_named(data: dict[str, Any], tmp_path: Path) -> None:
    gains = {"gains": {"k_d": 2.0}, "typed": "controller.k_d=1.5"}
    with_car = {"car": {"m": 1800.0}, "typed": "plant.m=1500"}
    washout = {"typed": "controller.k_d=1.5", "controller": WASHOUT}
    answers = asked(tmp_path, data, gains, with_car, washout)["answers"]
    assert [each["warnings"] for each in answers] == [
        ["controller.k_d = 1.5 is typed and goes before the slider, 2"],
        ["plant.m = 1500 is typed and goes before the slider, 1800"],
        ["controller.k_d: SpeedWashout has no such parameter and runs without it"],
    ]


@pytest.mark.parametrize(
    ("t_return", "sport", "comfort"),
    [(0.0047, 0.00235, 0.0094), (0.003, 0.002, 0.006), (0.012, 0.006, 0.0235), (0.03, 0.015, 0.03)],
)
def test_the_character_turns_a_gain_as_far_as_its_slider_goes(
    data: dict[str, Any], tmp_path: Path, t_return: float, sport: float, comfort: float
) -> None:
    """From 2 ms, the least that the FMU takes, to five times the value at the start; what is typed beyond stays."""
    gains = {} if t_return == 0.0047 else {"t_return": t_return}
    answers = asked(tmp_path, data, *({"gains": gains, "character": character} for character in (0.0, 1.0)))["answers"]
    assert [each["gains"]["t_return"] for each in answers] == pytest.approx([sport, comfort])


def test_every_slider_has_its_value_between_its_ends_also_one_below_0(data: dict[str, Any]) -> None:
    every = {knob["name"]: knob for kind in data["knobs"].values() for knob in kind}
    assert all(knob["low"] <= knob["value"] <= knob["high"] for knob in every.values())
    assert [every["shape_2"][end] for end in ("low", "value", "high")] == pytest.approx([-2.3, -0.46, 0.0])
    assert [every["shape_1"][end] for end in ("low", "value", "high")] == pytest.approx([0.0, 0.57, 2.85])


DEMANDS = (
    [[0, -12], [1, -12], [1, 100]],
    [[0, 5], [1, 5], [1.5, 60]],
    [[0, 5], [1, 5], [1.6, 60]],
    [[0, 0], [1, 0], [1, 50], [1.2, 20]],
    [[0, 3], [2, 3]],
)


def test_a_step_that_is_drawn_is_the_one_that_a_manoeuvre_of_a_file_has(data: dict[str, Any], tmp_path: Path) -> None:
    steps = asked(tmp_path, data, demands=DEMANDS)["steps"]
    assert [each and tuple(each) for each in steps] == [
        step_of(points([(float(t), float(T)) for t, T in demand])) for demand in DEMANDS
    ]


def test_a_page_takes_the_place_of_no_other_file(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["explore", "trip.csv", "--output", "trip.csv", "--no-browser"])
    assert "argument --output: 'trip.csv': the page is a .html" in capsys.readouterr().err


def test_the_page_is_small_and_names_the_fmus_inside(page: Path, data: dict[str, Any]) -> None:
    assert page.stat().st_size < LARGEST
    text = page.read_text(encoding="utf-8")
    assert not re.search(r"""(src|href)\s*=\s*["']https?:""", text)
    for fmu in data["loops"]["fmus"].values():
        assert re.fullmatch(r"\{[0-9a-f-]{36}\}", fmu["guid"])
        assert re.fullmatch(r"[0-9a-f]{64}", fmu["sources"])


@pytest.mark.slow
def test_a_recording_and_a_car_are_on_the_page(native: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    loops()
    path, drive = tmp_path / "page.html", tmp_path / "trip.csv"
    rows = (ROOT / "harness/manoeuvres/data/town_drive.csv").read_text(encoding="utf-8").splitlines()
    at = len(rows) // 2
    drive.write_text(
        "\n".join([*rows[:at], rows[at].rpartition(",")[0] + ",3276.7", *rows[at + 1 :]]), encoding="utf-8"
    )
    given = ["--vehicle", "examples/cars/van.toml", "--plant", DESIGN, "--controller", OURS]
    where = ["--fmus", str(native.parent), "--build", "native", "--output", str(path), "--no-browser", "--quiet"]
    assert main(["explore", str(drive), *given, *where]) == 0
    assert f"line {at + 1}: " in caplog.text, "what is odd is said"
    assert path.stat().st_size < 1_000_000


@pytest.mark.slow
def test_a_block_of_ones_own_is_compiled_into_the_page(native: Path, native_builder: Any, tmp_path: Path) -> None:
    """Its native FMU has the C source; what --set gives goes before the manoeuvre, as in a run."""
    from driveline.fmus.catalogue import EVERY

    loops()
    copyfile(native_builder(EVERY[WASHOUT], native.parent), tmp_path / "Mine.fmu")
    args = explore.Arguments(fmus=native.parent, build="native", set=(("plant.v_0", 8.0),))
    made = content(all_loops(args, [DESIGN], [str(tmp_path / "Mine.fmu")]))
    (run,) = asked(tmp_path, made, {"controller": "Mine"})["answers"]
    changes: Any = {"controller": WASHOUT, "folder": native.parent, "build": "native"}
    results = simulate(MANOEUVRES["tipin15"], DESIGN, parameters={"plant.v_0": 8.0}, **changes)
    assert column(tmp_path, 0, "plant.T_gear") == pytest.approx(at_samples(results)["plant.T_gear"], abs=1e-7)
    assert run["worth"]["overshoot"] > 0.0


def test_what_is_for_a_recording_is_refused_without_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explore", "--from", "0", "--output", str(tmp_path / "page.html"), "--no-browser"]) == 2
    assert "--from, --to, --dbc, --column and --aliases are for a RECORDING" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_what_has_no_c_source_is_refused_with_what_takes_it_before_anything_is_built(
    built: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--controller", str(built / f"{OURS}.fmu"), "--plant", DESIGN, "--fmus", str(tmp_path / "none")]
    assert main(["explore", *words, "--output", str(tmp_path / "page.html"), "--no-browser"]) == 2
    error = capsys.readouterr().err
    assert f"{OURS}.fmu: a page has loops of FMUs that were built from Python" in error
    assert "`driveline compare --report`" in error
    assert list(tmp_path.iterdir()) == []


def test_without_zig_and_module_or_recording_one_line_says_so_and_nothing_is_built(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(module, "PACKAGED", tmp_path / "none")
    monkeypatch.setattr(module, "user_cache", lambda: tmp_path)
    monkeypatch.setattr("fmublocks.native.compiler.find_spec", lambda _: None)
    monkeypatch.setattr(explore, "all_loops", pytest.fail)
    assert main(["explore", "--output", str(tmp_path / "page.html")]) == 2
    said = r"driveline explore: there is no Zig .* pip install ziglang; or .* from a wheel\n"
    assert re.fullmatch(said, capsys.readouterr().err)
    monkeypatch.setattr(module, "require_possible", lambda: None)
    assert main(["explore", str(tmp_path / "trip.csv"), "--output", str(tmp_path / "page.html")]) == 2
    assert re.fullmatch(r"driveline explore: .*trip\.csv.*\n", capsys.readouterr().err)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_the_module_made_again_is_the_same_and_imports_nothing(tmp_path: Path) -> None:
    kept = loops()
    module.write_standard(tmp_path / "again.json")
    assert json.loads((tmp_path / "again.json").read_text(encoding="utf-8")) == kept
    code = gunzip(b64decode(kept["code"]))
    assert code[:4] == b"\0asm"
    assert b"wasi_snapshot" not in code


@pytest.fixture
def opened(chromium: Browser, page: Path) -> Iterator[Browser]:
    chromium.open("about:blank", "true")
    chromium.open(page.as_uri())
    yield chromium
    assert chromium.console() == []


def settled(browser: Browser, action: str) -> None:
    """Does something and waits for the next curves."""
    before = browser.js("document.body.dataset.drawn")
    browser.js(action)
    browser.until(f"document.body.dataset.drawn !== '{before}'")
    browser.painted()


TURN = (
    "(() => {{ const e = document.getElementById('knob {0}'); e.value = {1}; e.dispatchEvent(new Event('input')) }})()"
)
TYPE = "(() => {{ const e = document.getElementById('{0}'); e.value = '{1}'; e.dispatchEvent(new Event('change')) }})()"


def test_curves_are_drawn_and_nothing_is_loaded(opened: Browser, page: Path) -> None:
    torque = opened.figure("gear torque in N·m")
    assert torque.x() == (0.9, 2.4)
    assert torque.pixels(BLUE) > 300
    assert torque.pixels(GREY) > 300
    assert [each for each in opened.fetched() if not each.startswith("blob:")][-1:] == [page.as_uri()]


def test_the_numbers_in_the_browser_are_those_of_simulate(opened: Browser, native: Path) -> None:
    settled(opened, TURN.format("k_d", 2.0))
    shown = np.array(opened.js(f"Array.from(shown.runs.get('{OURS}').run['plant.T_gear'])"))
    changes: Any = {"parameters": {"controller.k_d": 2.0}, "folder": native.parent, "build": "native"}
    results = at_samples(simulate(MANOEUVRES["tipin15"], DESIGN, **changes))["plant.T_gear"]
    assert shown == pytest.approx(results, abs=1e-9 * np.ptp(results))


def test_a_slider_is_marked_and_the_link_carries_it_and_the_way_back_works(opened: Browser) -> None:
    before = opened.js("document.getElementById('metrics').textContent")
    opened.js("document.getElementById('knob phi_B').dispatchEvent(new Event('pointerdown'))")
    settled(opened, TURN.format("phi_B", 0.05))
    opened.until("location.hash === '#phi_B=0.05'")
    assert opened.js("document.getElementById('knob phi_B').closest('.knob').className") == "knob changed"
    assert opened.js("document.getElementById('metrics').textContent") != before
    settled(opened, TYPE.format("plant", VEHICLE))
    settled(opened, "history.back()")
    assert opened.js("wanted.plant") == DESIGN
    settled(opened, "history.back()")
    assert opened.js("[Object.keys(wanted.car).length, document.getElementById('metrics').textContent]") == [0, before]


def test_what_a_link_has_and_the_page_does_not_take_is_said(opened: Browser, page: Path) -> None:
    opened.open("about:blank", "true")
    opened.open(f"{page.as_uri()}#k_d=&slope=9&control=maybe&with=Nope&of=1&omega_w=4")
    said = "left out of the link: control=maybe, with=Nope, k_d=, slope=9, of"
    assert opened.js("document.getElementById('status').textContent") == said
    assert opened.js("wanted.gains") == {"omega_w": 4.0}
    opened.open("about:blank", "true")
    opened.open(f"{page.as_uri()}#manoeuvre=launch_ice", "document.getElementById('status')?.textContent")
    said = "launch_ice has a road that TwoMassDriveline does not have; ValidationVehicle can drive it"
    assert opened.js("document.getElementById('status').textContent") == said


def test_a_value_out_of_bounds_is_refused_beside_its_slider(opened: Browser) -> None:
    opened.js(TYPE.format("knob k_d value", "-1"))
    refusal = "document.getElementById('knob k_d').closest('.knob').querySelector('.refusal').textContent"
    assert re.match(r"0 to \d+ N\.m\.s/rad is allowed", opened.js(refusal))
    assert opened.js("wanted.gains.k_d ?? 'as it was'") == "as it was"
    settled(opened, TYPE.format("knob k_d value", "1.5"))
    assert opened.js(refusal) == ""


FIRST = ("plant", "manoeuvre", "control", "other controllers beside it", "gains", "knob character value")


def test_the_keyboard_reaches_all_in_order_and_turns_a_slider_and_goes_back(opened: Browser) -> None:
    assert [opened.press("TAB") for _ in range(9)] == [*FIRST, "knob character", "knob k_d value", "knob k_d"]
    assert opened.js("getComputedStyle(document.activeElement).outlineStyle") == "solid"
    pressed(opened, "ARROW_RIGHT")
    once = opened.js("wanted.gains.k_d")
    pressed(opened, "ARROW_RIGHT")
    assert opened.js("wanted.gains.k_d") - once == pytest.approx(once - 2.58, abs=0.01)
    settled(opened, "history.back()")
    assert opened.js("wanted.gains") == {}
    opened.js("get('knob k_d value').select()")
    assert opened.press("-", "1", "ENTER") == "knob k_d value"
    assert "is allowed" in opened.js(
        "document.activeElement.closest('.knob').querySelector('[role=alert]').textContent"
    )
    assert opened.js("document.activeElement.getAttribute('aria-invalid')") == "true"


def test_the_keyboard_draws_a_manoeuvre_and_zooms(opened: Browser) -> None:
    opened.js("get('manoeuvre').focus()")
    pressed(opened, "HOME")
    assert opened.js("[wanted.manoeuvre, wanted.free.T_driver]") == ["free", [[0, -12], [1, -12], [1, 100]]]
    opened.js("document.querySelector('#drawn circle:last-of-type').focus()")
    pressed(opened, "ARROW_UP")
    pressed(opened, "ARROW_RIGHT")
    assert opened.js("wanted.free.T_driver.at(-1)") == [1.05, 102]
    pressed(opened, "DELETE")
    assert opened.js("wanted.free.T_driver") == [[0, -12], [1, -12]]
    opened.js("document.querySelector('figure').focus()")
    (start, end), speed = opened.figure("gear torque in N·m").x(), opened.figure("motor speed in rad/s")
    opened.press("+")
    assert speed.x() == pytest.approx((start + (end - start) / 4, end - (end - start) / 4))
    opened.press("0")
    assert speed.x() == (start, end)


def pressed(browser: Browser, key: str) -> None:
    """Presses a key and waits for the next curves."""
    before = browser.js("document.body.dataset.drawn")
    browser.press(key)
    browser.until(f"document.body.dataset.drawn !== '{before}'")


def test_a_run_is_held_and_a_manoeuvre_drawn_and_files_are_those_that_commands_take(
    opened: Browser, tmp_path: Path
) -> None:
    settled(opened, TYPE.format("manoeuvre", "free"))
    settled(opened, TYPE.format("demand", "0, 0; 1, 0; 1.2, 80"))
    settled(opened, "document.getElementById('hold').click()")
    settled(opened, TURN.format("C", 150))
    rows = "[...document.querySelectorAll('#metrics tbody tr')].map((row) => row.cells[0].textContent)"
    assert opened.js(rows) == ["without control", OURS, "held 1"]
    assert opened.js("document.querySelectorAll('#drawn circle').length") == 3
    opened.js("(URL.createObjectURL = (blob) => { blob.text().then((text) => { window.saved = text }); return '#' })")
    for what, read, name, value in (("car", read_vehicle, "C", 150.0), ("gains", read_parameters, "k_d", 2.58)):
        opened.js("window.saved = undefined")
        opened.js(f"document.getElementById('save {what}').click()")
        opened.until("window.saved")
        (tmp_path / f"{what}.toml").write_text(opened.js("window.saved"), encoding="utf-8")
        assert read(tmp_path / f"{what}.toml")[name] == pytest.approx(value)


@pytest.mark.parametrize("width", [420, 1300])
def test_the_page_is_as_wide_as_the_screen(opened: Browser, width: int) -> None:
    size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500}
    opened.chrome.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        opened.painted()
        assert opened.js("document.documentElement.scrollWidth") <= width
        assert opened.figure("gear torque in N·m").pixels(BLUE) > 100
    finally:
        opened.chrome.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

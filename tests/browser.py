"""A page in a real browser: Chromium of the distribution, driven by selenium."""

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from shutil import which
from typing import Any

import numpy as np
import pytest
from PIL import Image

FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1300,1000",
)


@contextmanager
def browser(profile: Path) -> Iterator["Browser"]:
    """Skips the test, and says so, where there is no browser.

    Args:
        profile: an empty folder for what the browser keeps.
    """
    webdriver = pytest.importorskip("selenium.webdriver", reason="no selenium: pip install selenium")
    chromium, driver = which("chromium") or which("chromium-browser"), which("chromedriver")
    if not (chromium and driver):
        pytest.skip("no browser here: apt-get install chromium chromium-driver")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for flag in (*FLAGS, f"--user-data-dir={profile}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    chrome = webdriver.Chrome(options=options, service=webdriver.ChromeService(driver))
    try:
        yield Browser(chrome)
    finally:
        chrome.quit()


class Browser:
    """What a user does with a page and sees of it."""

    def __init__(self, chrome: Any) -> None:
        self.chrome = chrome

    def open(self, address: str, drawn: str = "document.body?.dataset.drawn") -> None:
        """Opens a page and waits until its figures are drawn, as an expression says; what was logged before is
        forgotten."""
        for log in ("browser", "performance"):
            self.chrome.get_log(log)
        self.chrome.get(address)
        self.until(drawn)
        self.painted()

    def js(self, code: str, *given: Any) -> Any:
        """The value of an expression; arguments are arguments[0] and so on."""
        return self.chrome.execute_script(f"return {code}", *given)

    def until(self, condition: str, seconds: float = 60.0) -> None:
        """Waits until an expression is true."""
        from selenium.webdriver.support.ui import WebDriverWait

        WebDriverWait(self.chrome, seconds, 0.05).until(lambda _: self.js(condition))

    def painted(self) -> None:
        self.chrome.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done()))"
        )

    def figure(self, label: str) -> "Figure":
        """That whose ordinate has this label."""
        return Figure(self, label)

    def picture(self, path: Path | None = None) -> np.ndarray:
        """What is seen, (height, width, 3)."""
        shot = self.chrome.get_screenshot_as_png()
        if path:
            path.write_bytes(shot)
        return np.asarray(Image.open(BytesIO(shot)).convert("RGB"))

    def pixels(self, frame: Sequence[float], colour: str) -> int:
        """How many between left, top, right and bottom are of a colour."""
        left, top, right, bottom = map(round, frame)
        piece = self.picture()[top:bottom, left:right].astype(int)
        wanted = [int(colour[k : k + 2], 16) for k in (1, 3, 5)]
        return int((np.abs(piece - wanted).max(axis=2) < 12).sum())

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Between two points of the window."""
        self._at(start).click_and_hold().perform()
        self._at(end).release().perform()
        self.painted()

    def click(self, point: tuple[float, float]) -> None:
        self._at(point).click().perform()
        self.painted()

    def press(self, *keys: str) -> str:
        """Keys as `selenium.webdriver.Keys` names them, or characters, one after the other.

        Returns:
            what has the focus then: its id, or what is written on it.
        """
        from selenium.webdriver import ActionChains, Keys

        for key in keys:
            ActionChains(self.chrome, duration=50).send_keys(getattr(Keys, key, key)).perform()
        self.painted()
        return str(self.js("document.activeElement.id || document.activeElement.textContent"))

    def _at(self, point: tuple[float, float]) -> Any:
        from selenium.webdriver import ActionChains

        actions = ActionChains(self.chrome, duration=50)
        actions.w3c_actions.pointer_action.move_to_location(*map(round, point))
        return actions

    def console(self) -> list[str]:
        """All that was written to it."""
        return [entry["message"] for entry in self.chrome.get_log("browser")]

    def fetched(self) -> list[str]:
        """Addresses that the page has asked for."""
        events = [json.loads(entry["message"])["message"] for entry in self.chrome.get_log("performance")]
        asked = (each["params"]["request"]["url"] for each in events if each["method"] == "Network.requestWillBeSent")
        return [address for address in asked if not address.startswith(("data:", "chrome"))]


class Figure:
    """One of the figures of a page (kit.js)."""

    def __init__(self, page: Browser, label: str) -> None:
        self._page = page
        self._label = label

    def js(self, code: str, *given: Any) -> Any:
        """The value of an expression of `figure`."""
        find = "const figure = [...figures].find((each) => each.panel.label === arguments[0]);"
        return self._page.chrome.execute_script(f"{find} return {code}", self._label, *given)

    def seen(self) -> tuple[float, float, float, float]:
        """Left, top, right and bottom of its frame in the window, after scrolling to it."""
        self.js("figure.element.scrollIntoView({block: 'center'})")
        self._page.painted()
        box = "figure.plot.over.getBoundingClientRect()"
        return tuple(self.js(f"[{box}.left, {box}.top, {box}.right, {box}.bottom]"))

    def pixels(self, colour: str) -> int:
        """How many in its frame are of a colour."""
        return self._page.pixels(self.seen(), colour)

    def x(self) -> tuple[float, float]:
        """From where to where its abscissa goes."""
        return tuple(self.js("[figure.plot.scales.x.min, figure.plot.scales.x.max]"))

    def zoom(self) -> None:
        """Drags a box over the middle of it."""
        left, top, right, bottom = self.seen()
        w, h = right - left, bottom - top
        self._page.drag((left + 0.3 * w, top + 0.2 * h), (left + 0.6 * w, top + 0.8 * h))

    def click_on_legend(self, entry: int) -> None:
        """On one of its names."""
        self.js("figure.legend.children[arguments[1]].click()", entry)
        self._page.painted()

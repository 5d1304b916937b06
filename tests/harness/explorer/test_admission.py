"""Who is answered by `driveline explore`, over plain HTTP."""

import asyncio
import os
import re
import signal
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from http.client import HTTPConnection, HTTPResponse
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from bokeh.core.types import ID
from bokeh.util.token import generate_jwt_token
from tornado.httputil import HTTPHeaders

from driveline.harness.explorer.admission import MOST_TABS, Admission, _session_of, foreign
from tests.harness.explorer.served import PATIENCE, Served
from tests.slow import slow

HOSTS = ["127.0.0.1:5006", "localhost:5006"]

UPGRADE = {
    "Upgrade": "websocket",
    "Connection": "Upgrade",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Key": "a" * 24,
}


@contextmanager
def asked(port: int, path: str = "/", **headers: str) -> Iterator[HTTPResponse]:
    """What is answered; names of headers with _ for -."""
    connection = HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    try:
        connection.request("GET", path, headers={name.replace("_", "-"): text for name, text in headers.items()})
        yield connection.getresponse()
    finally:
        connection.close()


@pytest.mark.parametrize(
    ("host", "headers"),
    [
        ("127.0.0.1:5006", {}),
        ("localhost:5006", {"Origin": "http://localhost:5006"}),
        ("LOCALHOST:5006", {"Origin": "http://127.0.0.1:5006", "Sec-Fetch-Site": "same-origin"}),
        ("127.0.0.1:5006", {"Sec-Fetch-Site": "none", "Sec-Fetch-Dest": "document"}),
        ("127.0.0.1:5006", {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Dest": "document"}),  # a link
    ],
)
def test_a_page_of_this_machine_is_answered(host: str, headers: dict[str, str]) -> None:
    assert foreign(HTTPHeaders(headers), host, HOSTS) is None


@pytest.mark.parametrize(
    ("host", "headers", "named"),
    [
        ("evil.example", {}, "Host evil.example: "),
        ("evil.example:5006", {}, "Host evil.example:5006: "),
        ("127.0.0.1:5007", {}, "Host 127.0.0.1:5007: "),
        ("127.0.0.1", {}, "Host 127.0.0.1: "),
        ("", {}, "Host : "),
        ("127.0.0.1:5006", {"Origin": "http://evil.example"}, "Origin http://evil.example: "),
        ("127.0.0.1:5006", {"Origin": "http://127.0.0.1:5007"}, "Origin http://127.0.0.1:5007: "),
        ("127.0.0.1:5006", {"Origin": "null"}, "Origin null: "),
        ("127.0.0.1:5006", {"Origin": "http://[evil"}, "Origin http://[evil: "),
        ("127.0.0.1:5006", {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Dest": "iframe"}, "Sec-Fetch-Site cross-site: "),
        ("127.0.0.1:5006", {"Sec-Fetch-Site": "same-site", "Sec-Fetch-Dest": "image"}, "Sec-Fetch-Site same-site: "),
    ],
)
def test_another_host_or_origin_is_refused_by_name(host: str, headers: dict[str, str], named: str) -> None:
    reason = foreign(HTTPHeaders(headers), host, HOSTS)
    assert reason
    assert reason.startswith(named)


@pytest.mark.parametrize("path", ["/", "/autoload.js?bokeh-autoload-element=a", "/metadata"])
@pytest.mark.parametrize("header", [{"Host": "evil.example"}, {"Origin": "http://evil.example"}])
def test_a_foreign_request_gets_one_line_and_no_session(running: Served, path: str, header: dict[str, str]) -> None:
    for _ in range(MOST_TABS + 1):  # as many sessions would leave no room
        with asked(running.port, path, **header) as refused:
            assert refused.status == 403
            text = refused.read().decode()
            assert re.fullmatch(r"(Host|Origin) .*evil\.example: .*\n", text)
    with asked(running.port) as answered:
        assert answered.status == 200


def test_the_socket_refuses_another_origin(running: Served) -> None:
    with asked(running.port, "/ws", Origin="http://evil.example", **UPGRADE) as refused:
        assert refused.status == 403


def test_only_this_machine_is_answered(running: Served) -> None:
    with socket.create_connection(("127.0.0.1", running.port), PATIENCE):
        pass
    with (
        pytest.raises(OSError, match=r"refused|reachable"),
        socket.create_connection(("127.0.0.2", running.port), PATIENCE),
    ):
        pass


@pytest.mark.parametrize(("path", "known"), [("/", False), ("/ws", False), ("/ws", True)])
@pytest.mark.parametrize("tabs", [MOST_TABS - 1, MOST_TABS])
def test_there_are_no_more_tabs_than_there_may_be(path: str, known: bool, tabs: int) -> None:
    """A page that is open already keeps its socket."""
    token = generate_jwt_token(ID("5"))
    sessions = [SimpleNamespace(id=str(number)) for number in (range(tabs) if known else range(10, 10 + tabs))]
    headers = HTTPHeaders({"Sec-WebSocket-Protocol": f"bokeh, {token}"} if path == "/ws" else {})
    said: dict[str, Any] = {}
    handler = SimpleNamespace(
        request=SimpleNamespace(headers=headers, host=HOSTS[0]),
        application=SimpleNamespace(get_sessions=lambda _: sessions),
        set_status=lambda status: said.update(status=status),
        set_header=lambda *_: None,
        finish=lambda text: said.update(text=text),
    )
    asyncio.run(Admission(HOSTS)._admit(handler))  # pyright: ignore[reportPrivateUsage]
    full = {"status": 503, "text": f"{MOST_TABS} tabs are open, which is all there may be: close one and reload\n"}
    assert said == (full if tabs == MOST_TABS and not known else {})


@pytest.mark.parametrize("token", ["", "bokeh", "bokeh, x", "bokeh, W10", "bokeh, ==="])
def test_a_token_that_is_none_is_no_session(token: str) -> None:
    assert _session_of(HTTPHeaders({"Sec-WebSocket-Protocol": token})) is None


@pytest.mark.parametrize("number", slow([signal.SIGINT, signal.SIGTERM], but=[signal.SIGTERM]))
@pytest.mark.slow
def test_a_stop_leaves_no_process_and_no_traceback(with_washout: Path, tmp_path: Path, number: int) -> None:
    served = Served(with_washout, tmp_path)
    group = os.getpgid(served.process.pid)
    code, errors = served.stop(number)
    assert (code, errors) == (128 + number, "driveline explore: stopped\n")
    with pytest.raises(ProcessLookupError):
        os.killpg(group, 0)

"""Who is answered by `driveline explore`, over plain HTTP."""

import os
import re
import signal
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from http.client import HTTPConnection, HTTPResponse
from pathlib import Path

import pytest

from driveline.harness.explorer.admission import foreign
from tests.harness.explorer.served import PATIENCE, Served
from tests.slow import slow

HOSTS = ["127.0.0.1:5006", "localhost:5006"]


@contextmanager
def asked(
    port: int, path: str = "/", method: str = "GET", content: str | None = None, **headers: str
) -> Iterator[HTTPResponse]:
    """What is answered; names of headers with _ for -."""
    connection = HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    try:
        named = {name.replace("_", "-"): text for name, text in headers.items()}
        connection.request(method, path, content, named)
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
    assert foreign({"Host": host, **headers}, HOSTS) is None


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
    reason = foreign({"Host": host, **headers}, HOSTS)
    assert reason
    assert reason.startswith(named)


@pytest.mark.parametrize(("method", "path"), [("GET", "/"), ("GET", "/settings"), ("POST", "/answer")])
@pytest.mark.parametrize("header", [{"Host": "evil.example"}, {"Origin": "http://evil.example"}])
def test_a_foreign_request_gets_one_line_and_no_run(
    running: Served, method: str, path: str, header: dict[str, str]
) -> None:
    with asked(running.port, path, method, "{}", **header) as refused:
        assert refused.status == 403
        assert re.fullmatch(r"(Host|Origin) .*evil\.example: .*\n", refused.read().decode())
    with asked(running.port) as answered:
        assert answered.status == 200


@pytest.mark.parametrize("path", ["/explorer.html", "/page", "/../server.py", "/uPlot.LICENSE", "/answer"])
def test_nothing_but_the_page_is_there(running: Served, path: str) -> None:
    with asked(running.port, path) as answered:
        assert answered.status == 404


@pytest.mark.parametrize(
    "content",
    ["", "{", "[]", "1", '{"tab": "a"}', '{"tab": "a", "request": {}}', '{"tab": "a", "request": 1, "save": "all"}'],
)
def test_what_is_no_request_is_refused_in_one_line(running: Served, content: str) -> None:
    with asked(running.port, "/answer", "POST", content) as refused:
        assert refused.status == 422
        assert refused.read() == b"what the page asks for is no request\n"


def test_only_this_machine_is_answered(running: Served) -> None:
    with socket.create_connection(("127.0.0.1", running.port), PATIENCE):
        pass
    with (
        pytest.raises(OSError, match=r"refused|reachable"),
        socket.create_connection(("127.0.0.2", running.port), PATIENCE),
    ):
        pass


@pytest.mark.parametrize("number", slow([signal.SIGINT, signal.SIGTERM], but=[signal.SIGTERM]))
@pytest.mark.slow
def test_a_stop_leaves_no_process_and_no_traceback(with_washout: Path, tmp_path: Path, number: int) -> None:
    served = Served(with_washout, tmp_path)
    group = os.getpgid(served.process.pid)
    code, errors = served.stop(number)
    assert (code, errors) == (128 + number, "driveline explore: stopped\n")
    with pytest.raises(ProcessLookupError):
        os.killpg(group, 0)

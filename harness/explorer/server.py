"""Serves the page on the loopback address, to nobody else."""

import json
import os
import socket
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError
from http.server import BaseHTTPRequestHandler
from pathlib import Path
from select import select
from socketserver import ThreadingTCPServer
from typing import Any

from ..base.errors import DrivelineError
from ..base.plain_text import words
from .admission import foreign
from .messages import NO_REQUEST, Typed, answer_of, request_of, settings
from .request_runs import Answer, RequestRunner
from .worker import Beside, Worker

ADDRESS = "127.0.0.1"

PAGE = Path(__file__).parent / "page"

FILES = {
    "/": ("explorer.html", "text/html"),
    "/explorer.css": ("explorer.css", "text/css"),
    "/explorer.js": ("explorer.js", "text/javascript"),
    "/uPlot.css": ("uPlot.min.css", "text/css"),
    "/uPlot.js": ("uPlot.iife.min.js", "text/javascript"),
}

LONGEST = 100_000
"""Bytes of what a page asks for."""

LOOK = 0.2
"""Seconds between two looks at whether somebody still waits for an answer."""

Save = Callable[[Answer], Sequence[Path]]
"""Writes an answer; gives the files."""


def serve(
    runner: RequestRunner, saves: dict[str, Save], typed: Typed, port: int, announce: Callable[[str], None]
) -> None:
    """Serves until the process is stopped.

    Args:
        saves: what the buttons of the page do, by what stands on them.
        typed: reads what is typed.
        port: 0: any that is free.
        announce: gets the address once the page can be opened.

    Raises:
        DrivelineError: the port is taken.
    """
    worker = Worker()
    runner.beside = beside = Beside()
    try:
        with _listening(port) as server:
            server.answers = Answers(runner, worker, saves, typed)
            announce(f"http://{ADDRESS}:{server.port}/")
            server.serve_forever()
    finally:
        worker.close()
        runner.beside = None
        beside.close()


def _listening(port: int) -> "_Server":
    try:
        return _Server((ADDRESS, port), _Handler)
    except OSError as error:
        reason = os.strerror(error.errno or 0)
        raise DrivelineError(f"port {port} cannot be used ({reason}); choose another --port") from error


class Answers:
    """What pages are told; the worker makes it, each time for the latest request of a tab."""

    def __init__(self, runner: RequestRunner, worker: Worker, saves: dict[str, Save], typed: Typed) -> None:
        self._runner, self._worker, self._saves, self._typed = runner, worker, saves, typed

    def settings(self) -> bytes:
        """What a page begins with."""
        return json.dumps(settings(self._runner, list(self._saves))).encode()

    def of(self, content: bytes, waits: Callable[[], bool]) -> bytes | None:
        """The runs of a request, or, if they are to be saved, the names of the files; None: nobody waits any more.

        Args:
            content: JSON with `tab`, the name of a tab; `request`; `save`, what stands on the button, or nothing.
            waits: whether somebody does.

        Raises:
            DrivelineError: it is refused.
        """
        try:
            sent = json.loads(content)
            asker = str(sent["tab"]), sent.get("save")
            save = self._saves[asker[1]] if asker[1] else None
            asked = sent["request"]
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise DrivelineError(NO_REQUEST) from error
        request = request_of(asked, self._runner, self._typed)
        self._runner.require(request)

        def job() -> bytes:
            answer = self._runner.answer(request)
            return "\n".join(map(str, save(answer))).encode() if save else answer_of(answer, self._runner)

        future = self._worker.ask(asker, job)
        while True:
            try:
                return future.result(LOOK)
            except TimeoutError:
                if not waits():
                    self._worker.forget(asker)
            except CancelledError:
                return None


class _Server(ThreadingTCPServer):
    daemon_threads = True
    allow_reuse_address = os.name == "posix"  # elsewhere it would share the port with others
    answers: Answers

    @property
    def port(self) -> int:
        return self.socket.getsockname()[1]

    @property
    def hosts(self) -> list[str]:
        """By which the page may be asked for."""
        return [f"{host}:{self.port}" for host in (ADDRESS, "localhost")]

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Nothing is said of a browser that has gone."""


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True
    server: _Server  # pyright: ignore[reportIncompatibleVariableOverride]

    def do_GET(self) -> None:
        """The page and its files."""
        if self._is_refused():
            return
        if self.path == "/settings":
            self._send(200, "application/json", self.server.answers.settings())
        elif self.path in FILES:
            file, kind = FILES[self.path]
            self._send(200, f"{kind}; charset=utf-8", (PAGE / file).read_bytes())
        else:
            self._tell(404, "there is no such page")

    def do_POST(self) -> None:
        """An answer."""
        if self._is_refused():
            return
        try:
            content = self.rfile.read(min(int(self.headers.get("Content-Length", 0)), LONGEST))
            answer = self.server.answers.of(content, self._waits)
        except DrivelineError as refusal:
            self._tell(422, str(refusal))
        except Exception as error:
            self._tell(500, words(error))
        else:
            self._send(200, "application/octet-stream", answer or b"")

    def _waits(self) -> bool:
        """Whether the browser does, which has asked for nothing else meanwhile."""
        readable, _, _ = select([self.connection], [], [], 0.0)
        try:
            return not readable or self.connection.recv(1, socket.MSG_PEEK) != b""
        except OSError:
            return False

    def _is_refused(self) -> bool:
        reason = foreign(self.headers, self.server.hosts)
        if reason:
            self.close_connection = True  # what it has sent beside is not read
            self._tell(403, reason)
        return bool(reason)

    def _tell(self, status: int, text: str) -> None:
        self._send(status, "text/plain; charset=utf-8", f"{text}\n".encode())

    def _send(self, status: int, kind: str, content: bytes) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Cache-Control", "no-store")
        try:
            self.end_headers()
            self.wfile.write(content)
        except OSError:  # the browser has gone
            self.close_connection = True

    def log_message(self, format: str, *args: Any) -> None:
        """Nothing is said of requests."""

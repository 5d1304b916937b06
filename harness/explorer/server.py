"""Serves the page on the loopback address, to nobody else."""

import logging
import os
import socket
from collections.abc import Callable
from typing import Any

from bokeh.application import Application
from bokeh.application.handlers import FunctionHandler
from bokeh.server.server import Server
from bokeh.settings import settings

from ..base.errors import DrivelineError
from ..base.interruption import between_callbacks
from .admission import Admission
from .request_runs import RequestRunner
from .view import Save, Typed, View
from .worker import Beside, Worker

ADDRESS = "127.0.0.1"

VANISHED = 2_000
"""After how many ms a tab that has gone is forgotten."""


def serve(
    runner: RequestRunner, saves: dict[str, Save], typed: Typed, port: int, announce: Callable[[str], None]
) -> None:
    """Serves until the process is stopped; every tab has a view of its own.

    Args:
        saves, typed: see `harness.explorer.view.View`.
        port: 0: any that is free.
        announce: gets the address once the page can be opened.

    Raises:
        DrivelineError: the port is taken.
    """
    settings.log_level = "fatal"  # of the page
    for name in ("asyncio", "bokeh", "tornado"):  # of a tab that has gone, and what a page of somebody's own sends
        logging.getLogger(name).setLevel(logging.CRITICAL)

    def open_view(document: Any) -> None:
        View(document, runner, worker, saves, typed)

    port = free(port)
    hosts = [f"{host}:{port}" for host in (ADDRESS, "localhost")]
    worker = Worker()
    runner.beside = beside = Beside()
    try:
        server = Server(
            {"/": Application(FunctionHandler(open_view))},
            address=ADDRESS,
            port=port,
            allow_websocket_origin=hosts,
            auth_provider=Admission(hosts),
            check_unused_sessions_milliseconds=VANISHED // 2,
            unused_session_lifetime_milliseconds=VANISHED,
        )
        try:
            with between_callbacks(server.io_loop.asyncio_loop):  # type: ignore[attr-defined]
                announce(f"http://{ADDRESS}:{port}/")
                server.start()
                server.io_loop.start()
        finally:
            server.unlisten()
            server.stop()
    finally:
        worker.close()
        runner.beside = None
        beside.close()


def free(port: int) -> int:
    """The port if it is free; of 0 one that is.

    Raises:
        DrivelineError: it is taken, or not for everybody.
    """
    try:
        with socket.create_server((ADDRESS, port)) as found:
            return found.getsockname()[1]
    except OSError as error:
        raise DrivelineError(
            f"port {port} cannot be used ({os.strerror(error.errno or 0)}); choose another --port"
        ) from error

"""Which requests the server answers: those of its own pages, and of no more tabs than there may be."""

from collections.abc import Awaitable, Callable, Sequence
from typing import Any
from urllib.parse import urlsplit

from bokeh.server.auth_provider import AuthProvider
from bokeh.server.util import check_allowlist
from bokeh.util.token import get_session_id
from tornado.httputil import HTTPHeaders

from ..base.plain_text import plain

MOST_TABS = 10
"""That are open at a time."""


class Admission(AuthProvider):
    """Refuses, in one line, a request before a session is made for it."""

    def __init__(self, hosts: Sequence[str]) -> None:
        """
        Args:
            hosts: by which the page may be asked for, with the port.
        """
        self._hosts = hosts
        super().__init__()

    @property
    def login_url(self) -> str:
        """Bokeh asks for one; nobody is ever sent there."""
        return "/"

    @property
    def get_user_async(self) -> Callable[[Any], Awaitable[str]]:
        return self._admit

    async def _admit(self, handler: Any) -> str:
        """What bokeh calls with a request that would make a session or open its socket."""
        headers: HTTPHeaders = handler.request.headers
        if reason := foreign(headers, handler.request.host, self._hosts):
            _refuse(handler, 403, reason)
        else:
            sessions = {session.id for session in handler.application.get_sessions("/")}
            if len(sessions) >= MOST_TABS and _session_of(headers) not in sessions:
                _refuse(handler, 503, f"{MOST_TABS} tabs are open, which is all there may be: close one and reload")
        return "of this machine"


def foreign(headers: HTTPHeaders, host: str, hosts: Sequence[str]) -> str | None:
    """Why a request is none of the pages of these hosts or of somebody who follows a link to them; None if it is.

    A name that somebody has made lead to this machine stands in `Host`; a page of another origin is named in `Origin`,
    or, where it only embeds what is asked for, betrayed by `Sec-Fetch-Site`.
    """
    if not check_allowlist(host.lower(), hosts):
        return f"Host {plain(host, 60)}: this page is at {' or '.join(hosts)}"
    origin = headers.get("Origin")
    if origin is not None and not check_allowlist(_host_of(origin), hosts):
        return f"Origin {plain(origin, 60)}: only pages of {' or '.join(hosts)} are answered"
    site, destination = headers.get("Sec-Fetch-Site", "none"), headers.get("Sec-Fetch-Dest")
    if site not in ("none", "same-origin") and destination != "document":
        return f"Sec-Fetch-Site {plain(site, 60)}: this page cannot be embedded in others"
    return None


def _host_of(origin: str) -> str:
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:
        return ""


def _session_of(headers: HTTPHeaders) -> str | None:
    """The session that a socket says it belongs to."""
    try:
        return get_session_id(headers.get("Sec-WebSocket-Protocol", "").rpartition(",")[2].strip())
    except (ValueError, KeyError, TypeError):  # of a token that is none
        return None


def _refuse(handler: Any, status: int, reason: str) -> None:
    handler.set_status(status)
    handler.set_header("Content-Type", "text/plain; charset=utf-8")
    handler.finish(f"{reason}\n")

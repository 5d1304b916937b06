"""Which requests the server answers: those of its own pages."""

from collections.abc import Mapping, Sequence
from email.message import Message
from urllib.parse import urlsplit

from ..base.plain_text import plain


def foreign(headers: Message | Mapping[str, str], hosts: Sequence[str]) -> str | None:
    """Why a request is none of the pages of these hosts or of somebody who follows a link to them; None if it is.

    A name that somebody has made lead to this machine stands in `Host`; a page of another origin is named in `Origin`,
    or, where it only embeds what is asked for, betrayed by `Sec-Fetch-Site`.

    Args:
        hosts: by which the page may be asked for, with the port.
    """
    host, origin = headers.get("Host", ""), headers.get("Origin")
    if host.lower() not in hosts:
        return f"Host {plain(host, 60)}: this page is at {' or '.join(hosts)}"
    if origin is not None and _host_of(origin) not in hosts:
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

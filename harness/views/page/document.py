"""A page: one file of HTML with all its scripts, styles and data."""

import gzip
import json
from base64 import b64encode
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent

KIT = tuple(HERE / name for name in ("uPlot.iife.min.js", "kit.js"))
STYLES = tuple(HERE / name for name in ("uPlot.min.css", "page.css"))

POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; "
    "style-src 'unsafe-inline'; img-src data: blob:"
)
"""Nothing is loaded from anywhere."""

DATA = "data"
"""Of the element that has the data of a page, compressed."""

DOCUMENT = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<link rel="icon" href="data:,">
<title>{title}</title>
<style>{styles}</style>
</head>
<body>
{body}
<script type="text/plain" id="{data_id}">{data}</script>
{scripts}
</body>
</html>
"""


def document(
    title: str, body: str, data: Any, scripts: Sequence[Path], styles: Sequence[Path] = (), extra: str = ""
) -> str:
    """The text of a page.

    Args:
        body: HTML.
        data: that its scripts unpack, as JSON.
        scripts, styles: files that come after the kit's.
        extra: elements before the scripts.
    """
    text = json.dumps(data, separators=(",", ":"), allow_nan=False).encode()
    read = [f"<script>\n{_inline(path)}</script>" for path in (*KIT, *scripts)]
    return DOCUMENT.format(
        policy=POLICY,
        title=escape(title),
        styles="\n".join(path.read_text(encoding="utf-8") for path in (*STYLES, *styles)),
        body=body,
        data_id=DATA,
        data=b64encode(gzip.compress(text, 9, mtime=0)).decode(),
        scripts="\n".join(filter(None, (extra, *read))),
    )


def _inline(path: Path) -> str:
    return path.read_text(encoding="utf-8").replace("</script", "<\\/script")

"""The page of `driveline explore` on the first page of the site."""

from pathlib import Path
from tempfile import TemporaryDirectory

from driveline.harness.explorer.content import content, write_page
from driveline.harness.explorer.module import built_as_sources

PAGE = "explore.html"

PICTURE = "![the page: sliders, metrics, curves without and with damping]"
"""What stands in the README in its place."""

FRAME = f"""<iframe src="{PAGE}" title="the loop with sliders" class="explorer" loading="lazy"></iframe>

[On a page of its own]({PAGE})"""


def page() -> str:
    """The page, with the loops of the project as they are built."""
    with TemporaryDirectory() as folder, built_as_sources() as given:
        path = Path(folder) / PAGE
        write_page(content(given), path)
        return path.read_text(encoding="utf-8")


def framed(markdown: str) -> str:
    """The first page with the explorer in the place of its picture."""
    return "\n".join(FRAME if line.startswith(PICTURE) else line for line in markdown.splitlines())

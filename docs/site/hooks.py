"""What mkdocs calls while it builds the site: see mkdocs.yml."""

from importlib.resources import files as contents
from pathlib import Path

from mkdocs.structure.files import File, Files  # pyright: ignore[reportMissingImports]

from docs.site import ROOT, commands, declared, equations, explored, gallery, links, numbers, reference

MADE = {gallery.PAGE: gallery.page(), "blocks.md": declared.blocks_page(), **commands.pages(), **reference.pages()}
"""Pages that are made for the site, by their path in it."""

HERE = Path(__file__).parent
COPIED = (
    HERE / "iframe-worker.js",
    HERE / "site.css",
    Path(str(contents("ziamath.fonts"))) / "STIXTwoMath-Regular.ttf",
)
"""Files of the site that no page is made from."""


def on_startup(command: str, dirty: bool) -> None:
    """Docstrings are read from the package as it is installed."""
    reference.link_packages()


def on_config(config):
    """A folder in the navigation stands for the pages that are made for it."""
    config.nav = _with_folders(config.nav)
    return config


def _with_folders(nav):
    if isinstance(nav, dict):
        return {title: _with_folders(content) for title, content in nav.items()}
    if isinstance(nav, list):
        return [_with_folders(each) for each in nav]
    return [page for page in MADE if page.startswith(nav)] if nav.endswith("/") else nav


def on_files(files: Files, config) -> Files:
    """Adds what is made, the pages of the repository, and the files that pages link to."""
    of_repository = {place: (ROOT / name).read_text(encoding="utf-8") for name, place in links.PAGES.items()}
    for page, text in (MADE | of_repository).items():
        files.append(File.generated(config, page, content=text))
    pages = [each.content_string for each in files.documentation_pages()]
    for place, picture in numbers.figures(pages):
        files.append(File.generated(config, place, content=picture))
    written = {each.src_uri: each.content_string for each in files.documentation_pages() if each.src_uri not in MADE}
    for name in links.files(written):
        files.append(File.generated(config, f"{links.FILES}/{name}", abs_src_path=str(ROOT / name)))
    files.append(File.generated(config, explored.PAGE, content=explored.page()))
    for path in COPIED:
        files.append(File.generated(config, path.name, abs_src_path=str(path)))
    return files


def on_page_markdown(markdown: str, page, config, files) -> str:
    """Numbers of studies, and links as they are on the site."""
    markdown = numbers.shown(markdown, "../" * page.file.src_uri.count("/"))
    if page.file.src_uri not in MADE:
        markdown = links.fitted(markdown, page.file.src_uri)
    return explored.framed(markdown) if page.file.src_uri == "index.md" else markdown


def on_page_content(html: str, page, config, files) -> str:
    """Equations that need nothing from anywhere."""
    return equations.drawn(html)

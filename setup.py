"""All is declared in pyproject.toml but the page of the package: the README with links that lead to the repository."""

import re
import tomllib
from pathlib import Path

from setuptools import setup

RELATIVE = re.compile(r"(!?)(\[[^\]]*\]\()(?!#|[a-z]+:)")
"""What stands before the address of a picture or of a page in the repository."""


def page(folder: Path) -> str:
    """The README of a release as it is read elsewhere: its pictures and pages are those of the tag."""
    (version,) = re.findall(r'^VERSION = "(.+)"$', (folder / "fmus/release.py").read_text(encoding="utf-8"), re.M)
    repository = tomllib.loads((folder / "pyproject.toml").read_text(encoding="utf-8"))["project"]["urls"]["Repository"]
    return RELATIVE.sub(
        lambda found: f"{found[0]}{repository}/{'raw' if found[1] else 'blob'}/v{version}/",
        (folder / "README.md").read_text(encoding="utf-8"),
    )


setup(long_description=page(Path(__file__).parent), long_description_content_type="text/markdown")

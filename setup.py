"""What pyproject.toml cannot declare: the folders of the checkout as packages of `driveline`, and the page of the
package: the README with links that lead to the repository."""

import re
import tomllib
from pathlib import Path

from setuptools import find_packages, setup

ROOT = Path(__file__).parent

RELATIVE = re.compile(r"(!?)(\[[^\]]*\]\()(?!#|[a-z]+:)")
"""What stands before the address of a picture or of a page in the repository."""

FOLDERS = ("models", "fmus", "harness")
"""Of the checkout; installed, each is a package of `driveline`, beside which nothing of ours lies."""


def page() -> str:
    """The README of a release as it is read elsewhere: its pictures and pages are those of the tag."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return RELATIVE.sub(
        lambda found: (
            f"{found[0]}{project['urls']['Repository']}/{'raw' if found[1] else 'blob'}/v{project['version']}/"
        ),
        (ROOT / "README.md").read_text(encoding="utf-8"),
    )


def _within(folder: str) -> list[str]:
    return [f"{folder}.{name}" for name in find_packages(folder)]


setup(
    packages=["driveline", *(f"driveline.{name}" for folder in FOLDERS for name in (folder, *_within(folder)))],
    package_dir={f"driveline.{folder}": folder for folder in FOLDERS},
    long_description=page(),
    long_description_content_type="text/markdown",
)

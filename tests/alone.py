"""Each package alone: `python -m tests.alone [PACKAGE ...]` installs its wheel into an empty environment, with nothing
of the checkout, and runs its tests there; says how much that takes on the disk."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from shutil import copytree, ignore_patterns
from tempfile import TemporaryDirectory

from tests import ROOT

PACKAGES = sorted(path.parent.name for path in ROOT.glob("packages/*/pyproject.toml"))

MOST = {"fmublocks": 110}
"""MB that a package may take with all that it needs."""


def run(*command: str | Path, folder: Path) -> None:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")


def megabytes(folder: Path) -> float:
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) / 1e6


def tested(package: str, wheels: Path, folder: Path) -> str:
    """Installs and tests a package; returns what it says of itself.

    Args:
        wheels: folder of those of all packages.
        folder: of the environment.
    """
    run(sys.executable, "-m", "venv", "--without-pip", folder, folder=ROOT)
    python = folder / "bin/python"
    install = (sys.executable, "-m", "pip", "--python", python, "install", "--quiet", "--find-links", wheels)
    constrained = ("--constraint", ROOT / "constraints.txt")
    run(*install, *constrained, package, folder=wheels)
    size = megabytes(next(folder.glob("lib/python*/site-packages")))
    if size > MOST.get(package, size):
        sys.exit(f"{package} takes {size:.0f} MB; {MOST[package]} are allowed")
    run(*install, *constrained, f"{package}[test]", folder=wheels)
    own = ROOT / "packages" / package
    pytest = (python, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-m", "not slow")
    run(*pytest, "-c", own / "pyproject.toml", "--rootdir", own, own / "tests", folder=wheels)
    return f"{package}: {size:.0f} MB installed, its tests pass"


def write_wheels(folder: Path) -> None:
    """Makes the wheels of all packages, of copies: what a build has left in the checkout would get into them."""
    with TemporaryDirectory() as temporary:
        sources = Path(temporary) / "sources"
        copytree(ROOT / "packages", sources, ignore=ignore_patterns("build", "*.egg-info", "tests", "_steps.*"))
        build = (sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation")
        run(*build, "--wheel-dir", folder, *(sources / package for package in PACKAGES), folder=sources)


def main(packages: list[str]) -> None:
    with TemporaryDirectory() as temporary, ThreadPoolExecutor(2) as pool:
        wheels = Path(temporary) / "wheels"
        wheels.mkdir()
        write_wheels(wheels)
        said = pool.map(lambda package: tested(package, wheels, Path(temporary) / package), packages)
        for text in said:
            print(text, flush=True)


if __name__ == "__main__":
    main(sys.argv[1:] or PACKAGES)

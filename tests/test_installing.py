"""What is published: the sources, a wheel that works in any folder, and the page that introduces it."""

import os
import re
import subprocess
import sys
import sysconfig
import tarfile
from email import message_from_bytes
from email.message import Message
from importlib.metadata import version
from pathlib import Path
from zipfile import ZipFile

import pytest
from markdown_it import MarkdownIt

from driveline.fmus.catalogue import FMUS
from tests import ROOT
from tests.alone import PACKAGES, write_wheels

VERSION = version("driveline-damping")

pytestmark = pytest.mark.slow  # builds and installs

NOT_PUBLISHED = (".ci/", ".github/", ".gitignore", ".pre-commit-config.yaml")


def ran(*command: str | Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """A command that has ended well, in a folder, without a way to the checkout."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done


@pytest.fixture(scope="module")
def published(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the sources, with the wheel that is made from them, and with those of the packages; one process at a
    time makes them in ROOT."""
    fcntl = pytest.importorskip("fcntl")
    folder = tmp_path_factory.mktemp("dist")
    write_wheels(folder)
    with (ROOT / "pyproject.toml").open("rb") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        ran(sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, ROOT, folder=folder)
    return folder


@pytest.fixture(scope="module")
def wheel(published: Path) -> Path:
    (path,) = published.glob("driveline_damping-*.whl")
    return path


@pytest.fixture(scope="module")
def metadata(wheel: Path) -> Message:
    with ZipFile(wheel) as archive:
        return message_from_bytes(archive.read(f"driveline_damping-{VERSION}.dist-info/METADATA"))


@pytest.fixture(scope="module")
def scripts(published: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Scripts of an environment with all wheels, and with the packages of others that run this test."""
    environment = tmp_path_factory.mktemp("environment")
    ran(sys.executable, "-m", "venv", "--without-pip", environment, folder=environment)
    python = environment / "bin/python"
    install = (
        "-m",
        "pip",
        "--python",
        python,
        "install",
        "--quiet",
        "--no-index",
        "--no-deps",
        *published.glob("*.whl"),
    )
    ran(sys.executable, *install, folder=environment)
    (packages,) = environment.glob("lib/python*/site-packages")
    (packages / "others.pth").write_text(sysconfig.get_path("purelib") + "\n")
    for name in ("driveline", *PACKAGES):
        where = ran(python, "-c", f"import {name}; print({name}.__file__)", folder=environment).stdout
        assert where.startswith(str(packages)), f"{name} is not that of the checkout"
    return environment / "bin"


@pytest.fixture(scope="module")
def away(scripts: Path, native: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder outside the checkout in which the wheel has built the FMUs."""
    folder = tmp_path_factory.mktemp("away")
    ran(scripts / "driveline", "build", folder=folder)
    return folder


def test_an_installed_wheel_builds_the_same_fmus_as_the_checkout(away: Path, built: Path, native: Path) -> None:
    for name in FMUS:
        assert (away / "build" / f"{name}.fmu").read_bytes() == (built / f"{name}.fmu").read_bytes()
        assert (away / "build/native" / f"{name}.fmu").read_bytes() == (native / f"{name}.fmu").read_bytes()


@pytest.mark.parametrize(
    "words",
    [
        "simulate --manoeuvre tipin15",
        "compare --manoeuvre tipin15 --plant TwoMassDriveline",
        "check --quick build/native/DampingController.fmu build/native/MotorTorqueLoop.fmu",
    ],
)
def test_an_installed_wheel_has_nothing_to_complain_of_in_any_folder(scripts: Path, away: Path, words: str) -> None:
    assert ran(scripts / "driveline", *words.split(), folder=away).stderr == ""


def tracked(*folders: str) -> list[str]:
    """Files of the project in these folders, or in all."""
    if not (ROOT / ".git").exists():
        pytest.skip("no checkout, which would tell what belongs to the project")
    return ran("git", "ls-files", *folders, folder=ROOT).stdout.splitlines()


def test_sources_and_wheel_have_what_they_must_and_nothing_outside_of_the_one_package(
    published: Path, wheel: Path
) -> None:
    (path,) = published.glob("*.tar.gz")
    with tarfile.open(path) as archive:
        there = {name.partition("/")[2] for name in archive.getnames()}
    assert {name for name in tracked() if not name.startswith(NOT_PUBLISHED)} - there == set()
    with ZipFile(wheel) as archive:
        there = set(archive.namelist())
    inside = {f"driveline/{name}" for name in tracked("models", "fmus", "harness")} | set(tracked("driveline"))
    assert inside <= there
    tops = {name.partition("/")[0] for name in there}
    assert {top for top in tops if not top.endswith((".dist-info", ".libs"))} == {"driveline"}


def test_the_page_of_the_package_leads_to_what_is_in_the_repository(metadata: Message) -> None:
    addresses = dict(url.split(", ") for url in metadata.get_all("Project-URL", []))
    tokens = MarkdownIt("commonmark").enable("table").parse(str(metadata.get_payload()))
    inline = [token for block in tokens for token in block.children or ()]
    pages = [str(token.attrs["href"]) for token in inline if token.type == "link_open"]
    pictures = [str(token.attrs["src"]) for token in inline if token.type == "image"]
    for address in (*pages, *pictures):
        assert address.startswith("https://"), address
    ours = re.compile(rf"{addresses['Repository']}/(blob|raw)/v{VERSION}/(.+)")
    found = [match for address in (*pages, *pictures) if (match := ours.fullmatch(address))]
    assert {match[1] for match in found} == {"blob", "raw"}
    for match in found:
        assert (ROOT / match[2]).is_file(), match[2]
    assert all(ours.fullmatch(picture)[1] == "raw" for picture in pictures)  # type: ignore[index]

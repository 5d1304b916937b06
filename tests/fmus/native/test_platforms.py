"""Binaries for all platforms, where the extra `cross` is installed; and the universal file for macOS."""

import re
import struct
import zipfile
from functools import cache

import pytest
from fmutesting.skipping import skipped_if_impossible

from driveline.fmus.catalogue import FMUS
from fmublocks.builds import builders
from fmublocks.native.compiler import MAC_ARM, MAC_INTEL, universal
from fmublocks.native.xcp import FOLDER

LARGEST = 280 * 1024
"""Of a file with four libraries, one of them for two processors. 150 kB were enough until Arm Macs had one twice,
200 kB until the grip of each wheel was a parameter, 210 kB until there was model exchange, 255 kB until A2L files told
where its memory is (XCP), 270 kB until getting and setting had a short way beside the full one."""


@pytest.fixture(scope="module")
def builder():
    with skipped_if_impossible():
        (made,) = builders("native", "all")
    return made


@pytest.fixture(scope="module")
def made(builder, tmp_path_factory):
    """The path of an FMU for all platforms, made once."""
    folder = tmp_path_factory.mktemp("all")
    return cache(lambda name: builder(FMUS[name], folder))


@pytest.mark.slow
def test_one_small_file_holds_all_platforms_and_a_rebuild_gives_the_same_bytes(builder, made, tmp_path):
    assert made("ValidationVehicle").stat().st_size < LARGEST, "the largest of all"
    name = "WheelSpeedCan"
    path = made(name)
    with zipfile.ZipFile(path) as archive:
        names = set(archive.namelist())
    assert {f"binaries/linux64/{name}.so", f"binaries/win64/{name}.dll", f"binaries/darwin64/{name}.dylib"} <= names
    assert f"binaries/aarch64-darwin/{name}.dylib" in names
    assert builder(FMUS[name], tmp_path).read_bytes() == path.read_bytes()


def test_a_library_for_macos_asks_for_no_later_one_than_11(made):
    with zipfile.ZipFile(made("WheelSpeedCan")) as archive:
        library = archive.read("binaries/aarch64-darwin/WheelSpeedCan.dylib")
    assert least_macos(library) == (11, 0)


def least_macos(library: bytes) -> tuple[int, int]:
    """The version that the load command LC_BUILD_VERSION of a Mach-O file asks for."""
    (count,) = struct.unpack_from("<I", library, 16)
    place = 32
    for _ in range(count):
        command, size = struct.unpack_from("<2I", library, place)
        if command == 0x32:
            minor, major = struct.unpack_from("<x2B", library, place + 12)
            return major, minor
        place += size
    raise AssertionError("there is no LC_BUILD_VERSION")


def test_a_universal_file_tells_where_the_part_of_each_processor_is():
    parts = {MAC_INTEL: b"intel", MAC_ARM: b"arm" * 10_000}
    file = universal(parts)
    magic, count = struct.unpack_from(">II", file)
    assert (magic, count) == (0xCAFEBABE, 2)
    for place, content in zip((8, 28), parts.values(), strict=True):
        _, _, offset, size, alignment = struct.unpack_from(">IIIII", file, place)
        assert file[offset : offset + size] == content
        assert offset % (1 << alignment) == 0


def test_the_addresses_of_a_library_for_windows_are_in_its_data(made):
    name = "WheelSpeedCan"
    with zipfile.ZipFile(made(name)) as archive:
        library = archive.read(f"binaries/win64/{name}.dll")
        texts = [archive.read(f"{FOLDER}/{platform}/{name}.a2l").decode() for platform in ("win64", "linux64")]
    (header,) = struct.unpack_from("<I", library, 0x3C)
    count, size = struct.unpack_from("<H12xH", library, header + 6)
    sections = [struct.unpack_from("<8s2I", library, header + 24 + size + 40 * k) for k in range(count)]
    (data,) = [(first, first + length) for name, length, first in sections if name.rstrip(b"\0") == b".data"]
    on_windows, on_linux = ([int(a, 16) for a in re.findall(r"(?:VALUE|ECU_ADDRESS) 0x(\w+)", t)] for t in texts)
    assert data[0] <= min(on_windows) < max(on_windows) < data[1]
    assert {a - b for a, b in zip(on_windows, on_linux, strict=True)} == {on_windows[0] - on_linux[0]}

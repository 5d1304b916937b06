"""Archives that are not to be unpacked, made from an FMU that is in order."""

import stat
from collections.abc import Callable
from pathlib import Path
from zipfile import ZipFile, ZipInfo

NAME = "resources/extra.txt"
"""Of the entry that is added."""


def _added(name: str = NAME, content: bytes = b"content", **attributes: int) -> Callable[[Path], None]:
    def add(path: Path) -> None:
        entry = ZipInfo(name)
        for attribute, value in attributes.items():
            setattr(entry, attribute, value)
        with ZipFile(path, "a") as archive:
            archive.writestr(entry, content)

    return add


def _patched(in_header: int, in_directory: int, value: bytes) -> Callable[[Path], None]:
    """Overwrites bytes of an added entry, counted from the beginning of its header and of its directory entry."""

    def patch(path: Path) -> None:
        _added()(path)
        data = bytearray(path.read_bytes())
        with ZipFile(path) as archive:
            header = archive.getinfo(NAME).header_offset
        directory = data.rindex(b"PK\1\2")
        for place in (header + in_header, directory + in_directory):
            data[place : place + len(value)] = value
        path.write_bytes(data)

    return patch


def _cut(path: Path) -> None:
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])


HOSTILE: dict[str, tuple[Callable[[Path], None], str, str]] = {
    "absolute": (_added("/tmp/driveline-escaped"), "archive-path", "/tmp/driveline-escaped leaves the folder"),
    "outside": (_added("resources/../../escaped"), "archive-path", r"\.\./escaped leaves the folder"),
    "drive": (_added("C:/escaped"), "archive-path", "leaves the folder"),
    "backslash": (_added("resources\\escaped"), "archive-path", "has a backslash"),
    "link": (_added(external_attr=(stat.S_IFLNK | 0o777) << 16), "archive-link", f"{NAME} is a link"),
    "encrypted": (_patched(6, 8, b"\1"), "archive-encrypted", f"{NAME} is encrypted"),
    "method": (_patched(8, 10, b"\x63"), "archive-method", f"{NAME} is packed with the method 99"),
    "crc": (_patched(14, 16, b"\1\2\3\4"), "archive-damaged", f"(?i)crc.*{NAME}|{NAME} is damaged"),
    "cut": (_cut, "readable", "is not an FMU: File is not a zip file"),
    "escapes": (_added("resources/\033[31m/../../x"), "archive-path", r"resources/ \[31m/../../x leaves"),
}
"""Each what is done to the archive, the rule of `driveline check` that it breaks, and what is said of it."""

"""Digests of files."""

import hashlib
from collections.abc import Iterable
from io import BytesIO
from pathlib import Path


def digest(path: Path) -> str:
    """Of the content of a file, which may be larger than the memory; one of no size has none: /proc/kmsg never ends."""
    with path.open("rb") if path.stat().st_size else BytesIO() as file:
        return f"sha256:{hashlib.file_digest(file, 'sha256').hexdigest()}"


def digest_of_files(paths: Iterable[Path]) -> str:
    """SHA-256 of small files by their names and contents, wherever their folders are."""
    lines = sorted(path.name.encode() + b"\0" + hashlib.sha256(path.read_bytes()).digest() for path in paths)
    return hashlib.sha256(b"".join(lines)).hexdigest()

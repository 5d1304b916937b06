"""Digests of files."""

import hashlib
from pathlib import Path


def digest(path: Path) -> str:
    """Of the content of a file, which may be larger than the memory."""
    with path.open("rb") as file:
        return f"sha256:{hashlib.file_digest(file, 'sha256').hexdigest()}"

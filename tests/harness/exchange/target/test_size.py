"""What the controller takes of its processor, counted without a compiler."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from driveline.harness.exchange.target import size


def test_memory_is_counted_in_numbers_of_four_bytes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two states: the old one and the next."""
    monkeypatch.setattr(size, "_flash", lambda path: {"law.o": 100, "image.elf": 250}[path.name])
    (tmp_path / "law.su").write_text("a.c:1:f\t16\tstatic\na.c:9:g\t48\tstatic\n", encoding="utf-8")
    (tmp_path / "image.map").write_text("/lib/libm.a(lib_a-sqrt.o)\n/lib/libc.a(lib_a-memcpy.o)\n", encoding="utf-8")
    link: Any = SimpleNamespace(states=40, inputs=7, outputs=5, parameters=30)
    found = size.size_of(tmp_path / "image.elf", "law", link)
    assert found == size.Size(100, 250, 4 * (2 * 40 + 7 + 5), 4 * 30, 48, ("memcpy", "sqrt"))

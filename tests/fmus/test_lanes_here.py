"""Lanes are used where the processor has what their code needs, and nowhere else."""

import platform
from pathlib import Path

from driveline.fmus.lanes_here import lanes_here
from tests.together import together

AVX2, AVX512 = "avx avx2 fma", "avx512f avx512dq avx512vl"


@together(
    "system, machine, flags, lanes",
    [
        ("Linux", "x86_64", f"{AVX2} {AVX512}", 8),
        ("Linux", "x86_64", f"{AVX2} avx512f avx512dq", 4),
        ("Linux", "x86_64", "avx avx2", 0),
        ("Linux", "aarch64", AVX2, 0),
        ("Windows", "x86_64", AVX2, 0),
    ],
)
def test_their_number_is_that_of_the_processor(monkeypatch, system, machine, flags, lanes):
    monkeypatch.setattr(platform, "system", lambda: system)
    monkeypatch.setattr(platform, "machine", lambda: machine)
    monkeypatch.setattr(Path, "read_text", lambda *_, **__: f"processor\t: 0\nflags\t\t: fpu {flags}\nbugs\t\t:\n")
    assert lanes_here.__wrapped__() == lanes


def test_without_that_file_there_are_none(monkeypatch):
    def refused(*_, **__):
        raise PermissionError

    monkeypatch.setattr(platform, "system", lambda: "Linux")
    monkeypatch.setattr(Path, "read_text", refused)
    assert lanes_here.__wrapped__() == 0

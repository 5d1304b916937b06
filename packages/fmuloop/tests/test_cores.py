"""As many workers as cores: those that this process may use, of a container those that its share of time is worth."""

import os
from pathlib import Path

import pytest

from fmuloop import many_runs


@pytest.mark.parametrize(
    ("quota", "cores"),
    [
        (None, 8),
        ("max 100000", 8),
        ("50000 100000", 1),
        ("200000 100000", 2),
        ("200001 100000", 3),
        ("1600000 100000", 8),
    ],
)
def test_a_container_has_the_cores_of_its_quota(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, quota: str | None, cores: int
) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: range(8), raising=False)
    monkeypatch.setattr(many_runs, "QUOTA", tmp_path / "cpu.max")
    if quota is not None:
        (tmp_path / "cpu.max").write_text(quota + "\n")
    assert many_runs.cores() == cores

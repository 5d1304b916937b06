"""The figure of target and model has a column for each manoeuvre that it shows, also for one."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from driveline.harness.exchange.target.offline_results import SHOWN, plot_comparison
from tests.slow import slow


@pytest.mark.parametrize("count", slow([1, len(SHOWN)], but=[len(SHOWN)]))
@pytest.mark.slow
def test_every_manoeuvre_that_is_shown_has_its_column(count: int, tmp_path: Path) -> None:
    traces = np.zeros(50), np.ones(50)
    given: Any = [SimpleNamespace(case=SimpleNamespace(name=name), traces=traces) for name in (*SHOWN[:count], "other")]
    files = plot_comparison(given, "title", tmp_path / "target")
    assert files
    assert all(file.stat().st_size > 1000 for file in files)

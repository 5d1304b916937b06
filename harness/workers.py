"""Runs in processes of their own, so that independent simulations share the cores."""

import os
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context


def workers(count: int | None = None) -> ProcessPoolExecutor:
    """A pool of new interpreters (FMUs that run Python do not survive a fork), by default one a core.

    Their stderr is silent: progress belongs to the process that waits for them, and what goes wrong
    comes back as an exception.
    """
    return ProcessPoolExecutor(count, mp_context=get_context("spawn"), initializer=_silence)


def _silence() -> None:
    sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 (open as long as the process)

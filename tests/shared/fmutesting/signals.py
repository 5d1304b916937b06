"""Signals as a command meets them that a user starts."""

import os
import signal
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
"""Of the checkout."""

STOPPING = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


def heed_signals() -> None:
    """Given to Popen as preexec_fn: who runs the tests may ignore signals (`nohup`, `&`), and children inherit that."""
    for number in STOPPING:
        signal.signal(number, signal.SIG_DFL)


def started(*words: object, **environment: object) -> "subprocess.Popen[str]":
    """`python -m WORDS` in the folder of the project and a session of its own, with changes of the environment."""
    return subprocess.Popen(
        [sys.executable, "-m", *map(str, words)],
        env=os.environ | {name: str(value) for name, value in environment.items()},
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=heed_signals,
    )

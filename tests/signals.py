"""Signals as a command meets them that a user starts."""

import signal

STOPPING = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


def heed_signals() -> None:
    """Given to Popen as preexec_fn: who runs the tests may ignore signals (`nohup`, `&`), and children inherit that."""
    for number in STOPPING:
        signal.signal(number, signal.SIG_DFL)

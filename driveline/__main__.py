"""`driveline`, and `python -m driveline`."""

import atexit
import os
import signal
import sys

ENDING = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


def main() -> int:
    """Runs the command line in a process that ends with it; returns its exit code. Stopped while that is being
    imported, one line says so too; what comes after it, while the interpreter ends, changes nothing written."""
    code = 0
    try:
        for number in ENDING:
            if signal.getsignal(number) is signal.SIG_DFL:
                signal.signal(number, _stop)
        from .harness.commands.cli import main as command_line

        code = command_line()
    except KeyboardInterrupt as stop:
        print("driveline: stopped", file=sys.stderr)
        code = getattr(stop, "exit_code", 130)
    finally:
        for number in (signal.SIGINT, *ENDING):
            signal.signal(number, signal.SIG_IGN)
    if code > 128:  # threads may still compute, which no interpreter that ends bears
        atexit._run_exitfuncs()
        for stream in filter(None, (sys.stdout, sys.stderr)):  # None where it was closed
            stream.flush()
        os._exit(code)
    return code


def _stop(number: int, frame: object) -> None:
    stop = KeyboardInterrupt()
    stop.exit_code = 128 + number  # type: ignore[attr-defined]
    raise stop


if __name__ == "__main__":
    sys.exit(main())

"""The entry of a program, in a process that ends with it. Nothing else is imported before a stop is answered."""

import atexit
import os
import signal
import sys
from importlib import import_module

ENDING = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


def run_process(program: str, module: str) -> int:
    """Runs `main` of a module, which is that of a program; returns its exit code. Stopped while that is being imported,
    one line says so too; what comes after it, while the interpreter ends, changes nothing written."""
    code = 0
    try:
        for number in ENDING:
            if signal.getsignal(number) is signal.SIG_DFL:
                signal.signal(number, _stop)
        code = import_module(module).main()
    except KeyboardInterrupt as stop:
        print(f"{program}: stopped", file=sys.stderr)
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

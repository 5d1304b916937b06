"""How a process is stopped: at the keyboard, by a signal that ends processes, or by a reader that has gone or never
was."""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from time import sleep
from types import FrameType
from typing import NoReturn

ENDING = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
"""Signals that end a process as an interruption at the keyboard does."""


class Stopped(KeyboardInterrupt):
    """The process was told to end; `exit_code` is that which shells give for the signal."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.exit_code = 128 + number


@contextmanager
def stoppable() -> Iterator[None]:
    """Within it ENDING raise Stopped in the main thread, so that all is cleaned up; ignored ones stay ignored."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.getsignal(number) for number in ENDING}
    for number, handler in before.items():
        if handler is not signal.SIG_IGN:
            signal.signal(number, _stop)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _stop(number: int, frame: FrameType | None) -> None:
    for other in ENDING:  # what follows is the cleaning up
        signal.signal(other, signal.SIG_IGN)
    raise Stopped(number)


def script(main: Callable[[], int | None]) -> NoReturn:
    """Runs the main function of a module and ends the process with its exit code; stopped, all is cleaned up and one
    line says so, as by `driveline`."""
    try:
        with stoppable():
            code = main()
    except KeyboardInterrupt as stop:
        print(f"{Path(sys.argv[0]).stem}: stopped", file=sys.stderr)
        code = getattr(stop, "exit_code", 130)
    sys.exit(code)


@contextmanager
def unswallowed() -> Iterator[None]:
    """What a signal raises within it leaves it, even where the FMU whose Python it met has made a refusal of it, or
    Python another error, as it does where a class is made."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    raised: list[BaseException] = []

    def noting(handler: Callable[[int, FrameType | None], object]) -> Callable[[int, FrameType | None], None]:
        def note(number: int, frame: FrameType | None) -> None:
            try:
                handler(number, frame)
            except BaseException as stop:
                raised.append(stop)
                raise

        return note

    before = {number: handler for number in (signal.SIGINT, *ENDING) if callable(handler := signal.getsignal(number))}
    within = {number: noting(handler) for number, handler in before.items()}
    for number, handler in within.items():
        signal.signal(number, handler)
    try:
        yield
    except Exception:
        if not raised:
            raise
    finally:
        for number, handler in before.items():
            if signal.getsignal(number) is within[number]:  # else it is ignored by now
                signal.signal(number, handler)
    if raised:
        raise raised[0]


@contextmanager
def uninterrupted_children() -> Iterator[None]:
    """Processes and threads that are begun within it get nothing from the terminal: who began them ends them, and is
    itself stopped only when they are all known to it."""
    with _stopped_after():
        if not hasattr(signal, "pthread_sigmask"):
            yield
            return
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGHUP})
        try:
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _stopped_after() -> Iterator[None]:
    """What ENDING do within it, they do at its end."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    come: list[int] = []
    before = {number: handler for number in ENDING if callable(handler := signal.getsignal(number))}
    for number in before:
        signal.signal(number, lambda number, _: come.append(number))
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        for number in come[:1]:
            signal.raise_signal(number)


def end_with(parent: int, tidy: Callable[[], object] = lambda: None) -> None:
    """In a process that was begun for another one: from now on ends it when that is gone, killed before it could end
    those that it began. Windows tells no process that: there it goes on.

    Args:
        parent: number of that process.
        tidy: is called before.
    """

    def attend() -> None:
        while sys.platform == "win32" or os.getppid() == parent:
            sleep(1.0)
        tidy()
        os._exit(1)

    threading.Thread(target=attend, daemon=True).start()


def reopen_closed_streams() -> None:
    """What is printed to a stream that was closed before the process began goes nowhere, and the number of the stream
    is taken, so that no file that is opened later gets what an FMU or another process prints."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            stream = open(os.devnull, mode, encoding="utf-8")  # noqa: SIM115 (open as long as the process)
            os.set_inheritable(stream.fileno(), True)
            setattr(sys, name, stream)


STDOUT = "standard output"


@contextmanager
def named_stdout() -> Iterator[None]:
    """Within it an error of the system that writing to stdout raises, as that of a full disk, names it."""
    stream = sys.stdout

    def naming(method: Callable[..., object]) -> Callable[..., object]:
        def named(*text: str) -> object:
            try:
                return method(*text)
            except OSError as error:
                error.filename = STDOUT
                raise

        return named

    methods = {name: getattr(stream, name) for name in ("write", "flush")}
    for name, method in methods.items():
        setattr(stream, name, naming(method))
    try:
        yield
    finally:
        for name, method in methods.items():
            setattr(stream, name, method)


def forget_stdout() -> None:
    """Whatever is still to be printed goes nowhere, since what it was for does not take it."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())

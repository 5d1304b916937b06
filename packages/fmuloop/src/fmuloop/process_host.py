"""The isolated process in which FMUs that are not ours run: answers what `harness.cosimulation.isolated_process` asks.

A question is a function and its arguments, pickled; the answer is plain data. Whatever FMUs print is thrown away, and
nothing they do reaches the process that asks.
"""

import os
import pickle
import sys
from collections.abc import Callable
from mmap import mmap
from pathlib import Path
from typing import Any, BinaryIO

from toolground.interruption import end_with
from toolground.progress import hidden

from . import call_trace
from .process_answers import Answer, Bytes, send


def main() -> None:
    """Answers until nobody asks any more."""
    questions, answers = _silenced()
    end_with(os.getppid())  # an FMU that hangs does not outlive a parent that was killed
    with Path(sys.argv[1]).open("r+b") as page:
        call_trace.share(mmap(page.fileno(), 0))
    while True:
        try:
            function, arguments = pickle.load(questions)
        except EOFError:
            break
        answer = _answer(function, arguments)
        call_trace.rest()  # writing the answer may take longer than a call may
        send(answer, answers)
    os._exit(0)  # what FMUs have registered to be done at exit is not done


def _answer(function: Callable[..., Any], arguments: tuple[Any, ...]) -> Answer:
    try:
        with hidden():
            value = function(*arguments)
    except Exception as error:
        return Answer(error=error)
    return Answer(content=value) if isinstance(value, Bytes) else Answer(texts=value or ())


def _silenced() -> tuple[BinaryIO, BinaryIO]:
    """The pipes of questions and answers, moved to where no FMU writes by accident."""
    pipes = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDWR)
    for descriptor in range(3):
        os.dup2(nothing, descriptor)
    return pipes

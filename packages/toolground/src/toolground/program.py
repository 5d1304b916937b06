"""Running a program: whatever happens the user gets one line, and the exit code that it means."""

import sys
from argparse import Namespace
from collections.abc import Callable, Sequence
from errno import ENOSPC
from io import TextIOWrapper
from unicodedata import category

from . import command_line
from .errors import UserError
from .interruption import STDOUT, forget_stdout, named_stdout, reopen_closed_streams, stoppable, unswallowed
from .parsers import Parser
from .plain_text import reason
from .progress import hidden
from .status_line import waiting


def run_arguments(args: Namespace) -> int:
    """Runs the command of the arguments; returns its exit code.

    Raises:
        UserError: the user can mend what is wrong.
    """
    from .arguments import filled

    return args.found.run(filled(args.found.record, args))


def run_program(
    name: str,
    parser: Callable[[], Parser],
    arguments: Sequence[str] | None = None,
    run: Callable[[Namespace], int] = run_arguments,
) -> int:
    """Runs a program; returns its exit code, see EXIT_CODES; 130 stopped at the keyboard, 128 + n by signal n.

    Args:
        name: of the program.
        parser: makes that of the program.
        arguments: without its name; None for those of the process.
        run: takes what was parsed, returns the exit code.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    if words[:1] == ["help"]:
        words = [*words[1:], "--help"]
    command_line.words.set([name, *words])
    reopen_closed_streams()
    if isinstance(sys.stdout, TextIOWrapper):
        # who reads a pipe need not wait for the end either, and not every terminal has a middle dot
        sys.stdout.reconfigure(line_buffering=True, errors="replace")
    try:
        with stoppable(), unswallowed(), named_stdout():
            try:
                _require_printable(words)
                args = parser().parse_args(words)
                name = args.program
                silent = getattr(args, "quiet", False) or getattr(args, "json", False)
                with hidden(silent), waiting(name, enabled=not silent):
                    return run(args)
            finally:
                sys.stdout.flush()
    except BrokenPipeError as gone:
        forget_stdout()  # the reader has gone
        return int(gone.__context__.code or 0) if isinstance(gone.__context__, SystemExit) else 1
    except UserError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return error.exit_code
    except OSError as error:
        if error.filename == STDOUT:
            forget_stdout()
        elif error.errno == ENOSPC and error.filename is None:  # whoever writes results names them
            from .errors import full_disk

            error = full_disk()
        print(f"{name}: {reason(error)}", file=sys.stderr)
        return 1
    except MemoryError as error:
        print(f"{name}: not enough memory: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt as stop:
        print("; ".join([f"{name}: stopped", *getattr(stop, "__notes__", [])]), file=sys.stderr)
        return getattr(stop, "exit_code", 130)


UNPRINTABLE = {"Cc": "control characters", "Zl": "line ends", "Zp": "line ends", "Cs": "bytes that are no text"}
"""Categories of Unicode that no argument may have, but for the tabulator."""


def _require_printable(words: Sequence[str]) -> None:
    """
    Raises:
        UserError: a word, as the path of a file, would be no plain line in the messages, tables and names of files
            that repeat it.
    """
    for word in words:
        if found := next((UNPRINTABLE[c] for c in map(category, word.replace("\t", "")) if c in UNPRINTABLE), None):
            raise UserError(f"the argument {word[:60]!r} has {found}; rename the file")

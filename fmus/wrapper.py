"""What the binary of PythonFMU 0.7.0 gets wrong with the interpreter, put right from the Python side.

- When an exception leaves an instance, the binary gives up its references to the instance, its class
  and its log queue, and gives them up once more when the host frees the instance. `fmi_call` takes
  them back beforehand, so that the host can go on or free the instance.
- Every instantiation gives up a reference to the globals of the main script that it does not own, and
  leaves the resources folder at the head of the host's sys.path. `undo_loading` mends both.
"""

import ctypes
import functools
import sys
from collections.abc import Callable
from typing import Any


def _hold(value: Any) -> None:
    """One more reference to a value, never given up from Python."""
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(value))


def fmi_call(method: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator for the methods of an instance that the binary calls."""

    @functools.wraps(method)
    def call(self: Any, *arguments: Any) -> Any:
        try:
            return method(self, *arguments)
        except BaseException:
            for lost in (self, type(self), self.log_queue):
                _hold(lost)
            raise

    return call


def undo_loading(script_globals: dict[str, Any], script_locals: Any) -> None:
    """To be called at the end of the main script with its globals() and locals().

    The binary imports the script, then runs its text once for every instance with locals of their
    own; that run comes right after the folder was put at the head of sys.path.
    """
    if script_locals is not script_globals:
        del sys.path[0]
        _hold(script_globals)

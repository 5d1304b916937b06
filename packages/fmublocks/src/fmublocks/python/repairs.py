"""What the binary of PythonFMU 0.7.0 gets wrong with the interpreter, put right from the Python side.

- When an exception leaves an instance, the binary gives up its references to the instance, its class
  and its log queue, and gives them up once more when the host frees the instance. `fmi_call` takes
  them back beforehand, so that the host can go on or free the instance.
- It calls `_fmu_state_from_bytes` of the class, of which all instances would give up references when that
  raises an exception. `own_class` gives every instance a class of its own, so that `fmi_class_call` knows
  whose references to take back.
- At the exit of the process the binary destroys a static object twice: a use after free, which now and
  then ends in an abort (in some hosts always). `dismiss_guard` has it destroyed in time, while that is harmless.
- Every instantiation gives up a reference to the globals of the main script that it does not own, and
  leaves the resources folder at the head of the host's sys.path. `undo_loading` mends both.
"""

import ctypes
import functools
import os
import sys
from collections.abc import Callable
from pathlib import Path
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
            _hold_all(self)
            raise

    return call


def fmi_class_call(method: Callable[..., Any]) -> Callable[..., Any]:
    """The same for the methods of the class of an instance."""

    @functools.wraps(method)
    def call(cls: Any, *arguments: Any) -> Any:
        try:
            return method(cls, *arguments)
        except BaseException:
            _hold_all(cls.instance())
            raise

    return call


def _hold_all(instance: Any) -> None:
    """Takes back what the binary gives up when an exception leaves an instance."""
    _hold(instance)
    _hold(type(instance))
    _hold(instance.log_queue)


def own_class(slave: type) -> type:
    """A class like that, for one instance."""
    return type(slave.__name__, (slave,), {"__module__": slave.__module__})


def undo_loading(script_globals: dict[str, Any], script_locals: Any) -> None:
    """To be called at the end of the main script with its globals() and locals().

    The binary imports the script, then runs its text once for every instance with locals of their
    own; that run comes right after the folder was put at the head of sys.path.
    """
    if script_locals is not script_globals:
        del sys.path[0]
        _hold(script_globals)


_told_to_end: set[str] = set()
"""Binaries whose guard is destroyed first when the process ends."""


def dismiss_guard(resources: str, model_identifier: str) -> None:
    """To be called while an instance is made.

    The guard is there to finalize an interpreter that the binary itself has initialized. A host that is Python
    (it has a command line) never needs that; there the guard, made anew for every instance, is destroyed at once.
    In any other host it is destroyed when the process ends, before the binary's own static objects are: what
    is registered last with the C library is called first, and the binary stays loaded once it was.
    """
    binaries = Path(resources).parent / "binaries" / "linux64"
    inner = binaries / f"{model_identifier}.python.so"
    path = inner if inner.exists() else binaries / f"{model_identifier}.so"
    if sys.platform != "linux" or not path.exists():
        return
    binary = ctypes.CDLL(str(path), mode=os.RTLD_NOLOAD | os.RTLD_NOW)
    if sys.orig_argv:
        binary.finalizePythonInterpreter()
    elif str(path) not in _told_to_end:
        _told_to_end.add(str(path))
        ctypes.CDLL(None)["__cxa_atexit"](binary.finalizePythonInterpreter, None, None)

"""Nothing that only POSIX has is needed to import a module: what a system lacks is missed where it is used."""

import subprocess
import sys

import pytest

from tests import ROOT

ABSENT = {"fcntl", "grp", "pwd", "resource", "syslog", "termios"}
"""Modules that Windows does not have."""

LACKING = {
    "os": {"fork", "forkpty", "getuid", "geteuid", "killpg", "mkfifo", "setsid", "sysconf", "uname", "wait", "waitid"},
    "signal": {"SIGALRM", "SIGHUP", "SIGKILL", "SIGPIPE", "SIGXCPU", "alarm", "pthread_sigmask", "setitimer"},
}
"""What these modules lack there."""

PROGRAM = """
import builtins, importlib, os, signal, sys
names, absent, lacking = {names!r}, {absent!r}, {lacking!r}
OURS = ("driveline", "driverecords", "fmublocks", "fmucheck", "fmuloop", "toolground")
for name in names:  # other packages have what they need
    importlib.import_module(name)
for name in [name for name in sys.modules if name.partition(".")[0] in OURS]:
    del sys.modules[name]
for module, attributes in lacking.items():
    for attribute in attributes:
        delattr(sys.modules[module], attribute)
usual = builtins.__import__
def guarded(name, globals=None, *others, **named):
    if name in absent and (globals or {{}}).get("__name__", "").startswith(OURS):
        raise ImportError(name)
    return usual(name, globals, *others, **named)
builtins.__import__ = guarded
for name in names:
    importlib.import_module(name)
assert sys.modules["toolground.atomic_files"].fcntl is None
"""


@pytest.mark.slow
def test_every_module_is_imported_without_what_windows_lacks() -> None:
    paths = [path for room in ("models", "fmus", "harness") for path in sorted((ROOT / room).rglob("*.py"))]
    modules = [path.relative_to(ROOT).with_suffix("") for path in paths if path.stem not in ("__init__", "__main__")]
    names = [".".join(("driveline", *module.parts)) for module in modules]
    program = PROGRAM.format(names=names, absent=ABSENT, lacking=LACKING)
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]

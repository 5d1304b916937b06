"""The C compiler as tests call it: what it has made of a source once, it takes from where that was kept.

Tests compile the same FMUs and programs again and again, in every worker and in every run. `caching_compiler` puts a
command into a folder that stands in for `cc`. What it makes it keeps there, by the digest of the preprocessed source,
of all options and object files, and of the compiler. What is refused is not kept.
"""

import hashlib
import os
import shutil
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

COMPILER = "cc"
KEPT_FOR = 14 * 24 * 3600.0
"""How long what nobody asks for is kept, in s."""

SCRIPT = """#!/bin/sh
exec '{python}' -I -S '{file}' '{folder}' '{compiler}' "$@"
"""
OBJECTS = (".o", ".so")


def caching_compiler(folder: Path) -> Path | None:
    """The command, which keeps what it makes in the folder; None if there is no compiler, or no shell to run it."""
    compiler = shutil.which(COMPILER)
    if compiler is None or os.name != "posix":
        return None
    for old in folder.glob("*.made"):
        with suppress(OSError):  # another run has just taken it away
            if time.time() - old.stat().st_mtime > KEPT_FOR:
                old.unlink()
    command = folder / "cc"
    file = Path(__file__).resolve()
    script = SCRIPT.format(python=sys.executable, file=file, folder=folder, compiler=compiler)
    if not command.is_file() or command.read_text(encoding="utf-8") != script:
        _write(command, script.encode(), mode=0o755)
    return command


def main(folder: Path, compiler: str, options: list[str]) -> int:
    """Makes the file that the options name, or takes it from the folder; returns the exit code of the compiler."""
    key = _key(compiler, options)
    kept = folder / f"{key}.made"
    if key and (output_bytes := _whole(kept)) is not None:
        os.utime(kept)
        output = Path(_output(options))
        output.write_bytes(output_bytes)
        output.chmod(0o644 if "-c" in options else 0o755)
        return 0
    code = subprocess.run([compiler, *options], check=False).returncode
    if key and code == 0:
        content = Path(_output(options)).read_bytes()
        _write(kept, _digest(content) + content)
    return code


def _key(compiler: str, options: list[str]) -> str:
    """The digest of all that the output depends on; empty if there is no output, or the preprocessor refuses."""
    output = _output(options)
    if not output:
        return ""
    flags = [name for name in options if name not in ("-c", "-o", output) and not name.endswith((".c", *OBJECTS))]
    file = os.stat(compiler)
    parts = [f"{compiler} {file.st_size} {file.st_mtime_ns}".encode()]
    for name in options:
        if name.endswith(".c"):
            # the names of files are in what a debugger reads; that of the folder too, but nobody needs it
            places = ["-fno-working-directory"] if "-g" in flags else ["-P"]
            done = subprocess.run([compiler, *flags, "-E", *places, name], capture_output=True, check=False)
            if done.returncode:
                return ""
            parts.append(done.stdout)
        elif name.endswith(OBJECTS) and name != output:
            parts.append(Path(name).read_bytes())
        elif name != output and not name.startswith("-I"):  # what is included is in the preprocessed source
            parts.append(name.encode())
    return _digest(b"".join(map(_digest, parts))).hex()


def _output(options: list[str]) -> str:
    return options[options.index("-o") + 1] if "-o" in options[:-1] else ""


def _digest(content: bytes) -> bytes:
    return hashlib.sha256(content).digest()


def _whole(kept: Path) -> bytes | None:
    """What was kept; None if it is not there as it was written."""
    try:
        content = kept.read_bytes()
    except OSError:
        return None
    size = hashlib.sha256().digest_size
    return content[size:] if _digest(content[size:]) == content[:size] else None


def _write(path: Path, content: bytes, mode: int = 0o644) -> None:
    """Writes a file that is whole for whoever sees it."""
    unfinished = path.with_name(f"{path.name}.{os.getpid()}")
    unfinished.write_bytes(content)
    unfinished.chmod(mode)
    unfinished.replace(path)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2], sys.argv[3:]))

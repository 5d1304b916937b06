"""Running what the README of a package shows."""

import re
import shlex
import subprocess
import sys
from importlib import import_module
from pathlib import Path

BLOCK = re.compile(r"(?P<lead>[^\n]*)\n+```(?P<language>python|sh)\n(?P<text>.*?)```", re.DOTALL)

FILE = re.compile(r"`(\w+\.py)`:$")
"""How a line ends below which a file stands."""


def run_examples(package: str, readme: Path, folder: Path) -> str:
    """Runs the blocks of a README and the example of its package in a folder, one after the other; returns what they
    print. Files are written, of a shell the lines run that begin with the name of the package."""
    program = [sys.executable, "-c", "import sys; exec(sys.stdin.read())"]
    printed = ""
    for lead, language, text in BLOCK.findall(readme.read_text(encoding="utf-8")):
        if language == "python" and (name := FILE.search(lead)):
            (folder / name[1]).write_text(text, encoding="utf-8")
        elif language == "python":
            printed += _output(program, folder, text)
        else:
            own = (shlex.split(line, comments=True) for line in text.splitlines() if line.startswith(f"{package} "))
            printed += "".join(_output([sys.executable, "-m", *words], folder) for words in own)
    example = re.search(r"\n\n((?:    [^\n]*\n|\n)+)", import_module(package).__doc__ or "")
    assert example, f"{package} shows no example"
    return printed + _output(program, folder, re.sub(r"^    ", "", example[1], flags=re.MULTILINE))


def _output(command: list[str], folder: Path, text: str = "") -> str:
    done = subprocess.run(command, cwd=folder, input=text, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout

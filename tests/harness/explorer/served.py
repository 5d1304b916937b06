"""An explorer that runs in a process of its own."""

import re
import signal
from pathlib import Path

from tests.signals import started

DRAWN = "typeof shown !== 'undefined' && shown && !busy"
"""Whether a page shows its first answer."""

PATIENCE = 60.0
"""In s, for what takes milliseconds on a machine that has nothing else to do."""


class Served:
    """An explorer that runs."""

    def __init__(self, fmus: Path, folder: Path) -> None:
        self.folder = folder
        blocks = ["--controller", "DampingController", "--controller", "SpeedWashout"]
        command = ["explore", *blocks, "--fmus", fmus, "--output", folder, "--port", "0", "--build", "native"]
        self.process = started("driveline", *command)
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        found = re.match(r"http://127\.0\.0\.1:(\d+)/ ", line)
        assert found, line
        self.port = int(found[1])

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.port}/"

    def stop(self, number: int = signal.SIGINT) -> tuple[int, str]:
        """Its exit code and what it wrote to stderr."""
        self.process.send_signal(number)
        _, errors = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode, errors

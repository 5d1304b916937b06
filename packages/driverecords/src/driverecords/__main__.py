"""`driverecords`, and `python -m driverecords`."""

import sys

from toolground.entry import run_process


def main() -> int:
    """Runs the command line in a process that ends with it; returns its exit code."""
    return run_process("driverecords", "driverecords.cli")


if __name__ == "__main__":
    sys.exit(main())

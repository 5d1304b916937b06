"""`fmucheck`, and `python -m fmucheck`."""

import sys

from toolground.entry import run_process


def main() -> int:
    """Runs the command line in a process that ends with it; returns its exit code."""
    return run_process("fmucheck", "fmucheck.cli")


if __name__ == "__main__":
    sys.exit(main())

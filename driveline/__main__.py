"""`driveline`, and `python -m driveline`."""

import sys


def main() -> int:
    """Runs the command line; returns its exit code. Stopped while that is being imported, one line says so too."""
    try:
        from .harness.commands.cli import main as command_line

        return command_line()
    except KeyboardInterrupt:
        print("driveline: stopped", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())

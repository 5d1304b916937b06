"""Builds the FMUs, as `driveline build` does; `python build_fmus.py --help` says how."""

import sys

from driveline.harness.commands.cli import main

if __name__ == "__main__":
    sys.exit(main(["build", *sys.argv[1:]]))

"""Builds the FMUs, as `driveline build` does; `python build_fmus.py --help` says how."""

from argparse import ArgumentParser, RawDescriptionHelpFormatter
from pathlib import Path

from driveline.fmus.building import build_command
from driveline.fmus.errors import BuildError


def main() -> None:
    parser = ArgumentParser(
        description=build_command.DESCRIPTION,
        epilog=build_command.examples("python build_fmus.py"),
        formatter_class=RawDescriptionHelpFormatter,
    )
    build_command.add_arguments(parser, Path(__file__).parent / "build")
    arguments = parser.parse_args()
    try:
        build_command.run(arguments)
    except (BuildError, OSError) as reason:
        parser.error(str(reason))


if __name__ == "__main__":
    main()

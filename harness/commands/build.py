"""`driveline build`: makes the FMUs of the project, or one of a file of the user's own."""

import argparse

from ...fmus.building import build_command
from ..loop.places import BUILD

DESCRIPTION = build_command.DESCRIPTION
EXAMPLES = build_command.examples("driveline build")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    build_command.add_arguments(parser, BUILD)


def run(args: argparse.Namespace) -> int:
    build_command.run(args)
    return 0

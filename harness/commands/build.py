import argparse

from ...fmus.building import build_command
from ..loop.places import BUILD

__doc__ = f"{build_command.DESCRIPTION}\n{build_command.examples('driveline build')}"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    build_command.add_arguments(parser, BUILD)


def run(args: argparse.Namespace) -> int:
    build_command.run(args)
    return 0

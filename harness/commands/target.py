"""`driveline target`: the controller's C for a processor; each action is a module of its own, target_ACTION."""

import argparse
from importlib import import_module

from ...fmus.building.options import add_parameter_files
from ..loop.places import PLACES

DESCRIPTION = """\
The controller on the processor that it is meant for, in C (docs/target.md).
"""

EXAMPLES = """\
examples:
  driveline target export --vehicle car.toml --parameters gains.toml   its C, in single precision
  driveline target build                                               its FMU, whose step runs on the target
  driveline target image                                               the image, and its A2L description
  driveline target record                                              that C on an emulated Cortex-M4F
  driveline target ACTION --help                                       explains an action
"""

ACTIONS = {
    "export": "write the C of a controller",
    "build": "build the FMU of a controller that runs on an emulated Cortex-M4F",
    "image": "compile its image for that target, and describe it for calibration tools (A2L)",
    "record": "run it on an emulated Cortex-M4F, off-line, and compare",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    for name, text in ACTIONS.items():
        action = actions.add_parser(name, help=text, formatter_class=argparse.RawDescriptionHelpFormatter)
        action.command = f"target-{name}"  # type: ignore[attr-defined]  # its arguments are added when it is asked for


def add_controller(parser: argparse.ArgumentParser) -> None:
    """Which controller an action is for, with which values."""
    names = PLACES["controller"]
    parser.add_argument("--controller", choices=names, default=names[0], help="(default: %(default)s)")
    add_parameter_files(parser)


def run(args: argparse.Namespace) -> int:
    return import_module(f".target_{args.action}", __package__).run(args)

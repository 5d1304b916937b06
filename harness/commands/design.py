"""`driveline design`: computes the controller's gains and stores them as its default parameters."""

import argparse
import os
from pathlib import Path

NAME = "design"
HELP = "compute the gains of the controller"

STORED = Path("models/controller/gains.toml")

DESCRIPTION = """\
Solves the Riccati equations of the estimator and of the damping law for the weights stated in
harness/analysis/design.py and writes the result to models/controller/gains.toml, from where the
DampingController takes its default parameters. Run it in the root of the repository after a change of
the weights or of the design model, then `driveline build`.
"""

EXAMPLES = """\
examples:
  driveline design             store the gains
  driveline design --show      only print them
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--show", action="store_true", help="print the gains and store nothing")


def run(args: argparse.Namespace) -> int:
    # here and not above: only the design needs the models
    from ..analysis.design import design, stored

    text = stored(design())
    if args.show:
        print(text, end="")
        return 0
    partial = STORED.with_suffix(".part")
    partial.write_text(text)
    os.replace(partial, STORED)
    print(f"{STORED}  the build of DampingController takes its defaults from there")
    return 0

"""Builds the FMUs; `python build_fmus.py --help` says how."""

import argparse
from difflib import get_close_matches
from pathlib import Path

from fmus.builds import BUILDS, PLATFORMS, NotPossible, builders
from fmus.catalogue import FMUS
from fmus.fmu import Fmu
from fmus.own_file import NoFmu, fmu_in

DESCRIPTION = "Build the FMI 2.0 co-simulation FMUs of the damping loop."

EXAMPLES = f"""FMUs: {", ".join(FMUS)}

examples:
  python build_fmus.py                          all of them, into build/
  python build_fmus.py TwoMassDriveline         only that one
  python build_fmus.py --output /srv/fmus       somewhere else
  python build_fmus.py --build native           only the native ones, into build/native/
  python build_fmus.py --build native my.py     the block in a file of your own, see docs/native.md
  python build_fmus.py --platform all           native ones for Linux, Windows and macOS (extra `cross`)

The native build needs the extra `native` and a C compiler; where one of them is missing, it is left out
unless it is asked for.

The same sources give the same files, byte by byte.
"""


def known(name: str) -> Fmu:
    """The FMU of that name, or in the Python file of that path.

    Raises:
        NoFmu: there is none; says which are near.
    """
    if name in FMUS:
        return FMUS[name]
    if name.endswith(".py"):
        return fmu_in(Path(name))
    near = get_close_matches(name, FMUS, n=2, cutoff=0.5)
    hint = f"did you mean {' or '.join(near)}?" if near else f"there are {', '.join(FMUS)}"
    raise NoFmu(f"no FMU is called {name!r}; {hint}")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=DESCRIPTION, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="FMU", help="which to build (default: all)")
    parser.add_argument("--output", type=Path, default=Path("build"), help="folder (default: build)")
    parser.add_argument("--build", choices=BUILDS, help="which build (default: each that is possible here)")
    parser.add_argument("--platform", choices=PLATFORMS, default="host", help="of the native build (default: host)")
    arguments = parser.parse_args()
    try:
        fmus = [known(name) for name in arguments.names] or list(FMUS.values())
        if arguments.build != "native" and any(fmu not in FMUS.values() for fmu in fmus):
            parser.error("a block in a file of your own has a native build only: add --build native")
        chosen = builders(arguments.build, arguments.platform)
    except (NoFmu, NotPossible) as reason:
        parser.error(str(reason))
    for fmu in dict.fromkeys(fmus):
        for build in chosen:
            path = build(fmu, arguments.output)
            print(f"{path}  {path.stat().st_size / 1024:.0f} kB")


if __name__ == "__main__":
    main()

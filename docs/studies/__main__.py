"""Measures what the documentation says in numbers.

    python -m docs.studies                    # all studies, those that decide first
    python -m docs.studies results goals      # these
    python -m docs.studies --sentinels        # the rows that `make test` computes again, and what has moved
    python -m docs.studies goals --help       # what a study does with arguments of its own; it keeps nothing then
    python -m docs.studies --pictures         # the pictures of README and tutorial, drawn from the same numbers

The numbers go to docs/studies/data; what has moved beyond its tolerance is printed. A study that is stopped keeps what
it had; those that are done stay.
"""

import argparse
import os
import sys
import time
from collections.abc import Sequence
from unittest.mock import patch

from driveline.harness.loop.built_fmus import build_missing
from driveline.harness.loop.places import COMPARATORS, PLANTS
from fmublocks.errors import BuildError
from toolground.errors import UserError
from toolground.interruption import script

from . import data_file
from .pictures import draw_pictures
from .study import STUDIES, Difference, differences, study


def main(arguments: Sequence[str] | None = None) -> int:
    words = list(sys.argv[1:] if arguments is None else arguments)
    if words[:1] and words[0] in STUDIES and any(word.startswith("-") for word in words[1:]):
        return explore(words[0], words[1:])
    listed = (
        "\n".join(f"  {name:22} {study(name).purpose}" for name in STUDIES)
        if "-h" in words or "--help" in words
        else ""
    )
    parser = argparse.ArgumentParser(
        prog="python -m docs.studies",
        description=__doc__,
        epilog=f"studies:\n{listed}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("studies", nargs="*", metavar="STUDY", help="default: all")
    parser.add_argument("--sentinels", action="store_true", help="measures these rows alone, and keeps nothing")
    parser.add_argument("--pictures", action="store_true", help="measures nothing")
    args = parser.parse_args(words)
    if unknown := sorted(set(args.studies) - set(STUDIES)):
        parser.error(f"there is no study {', '.join(unknown)}; there are {', '.join(STUDIES)}")
    if args.pictures:
        print("\n".join(map(str, draw_pictures())))
        return 0
    build_all()
    return (check if args.sentinels else make)(args.studies or STUDIES)


def build_all() -> None:
    """The FMUs that studies run, where they are missing or stale."""
    for plant in PLANTS:
        build_missing(plant)
    for controller in COMPARATORS:
        build_missing(controller=controller)


def explore(name: str, arguments: Sequence[str]) -> int:
    """Runs a study with arguments of its own."""
    own = study(name).explore
    if own is None:
        print(f"python -m docs.studies {name}: takes no arguments", file=sys.stderr)
        return 2
    build_all()
    own(arguments)
    return 0


def make(names: Sequence[str]) -> int:
    """Measures studies, one after the other; returns 1 if one could not be measured, else 0."""
    code = 0
    for k, name in enumerate(names, 1):
        entry = study(name)
        print(f"[{k}/{len(names)}] {name}: {entry.purpose}, about {entry.seconds:g} s", flush=True)
        begin = _cpu_seconds()
        try:
            measured = entry.measure()
        except (UserError, BuildError) as failure:
            print(f"[{k}/{len(names)}] {name}: not measured: {failure}", flush=True)
            code = 1
            continue
        was = data_file.read(name).measured.tables if data_file.file_of(name).is_file() else {}
        data_file.write(name, measured, entry.seeds, _cpu_seconds() - begin)
        moved = [*differences(was, data_file.read(name).measured.tables)] if was else []
        print("\n".join([f"[{k}/{len(names)}] {name}: {told(moved)}", *map(str, moved)]), flush=True)
    return code


def check(names: Sequence[str]) -> int:
    """Measures the sentinels of studies; returns 1 if one has moved or could not be measured, else 0."""
    failed = False
    for name in names:
        begin = time.process_time()
        try:
            moved = sentinel_differences(name)
        except (UserError, BuildError) as failure:
            print(f"{name}: not measured: {failure}", flush=True)
            failed = True
            continue
        print("\n".join([f"{name}: {told(moved)}, {time.process_time() - begin:.1f} s", *map(str, moved)]), flush=True)
        failed |= bool(moved)
    return int(failed)


def sentinel_differences(name: str) -> list[Difference]:
    """What has moved in the sentinels of a study; measured by this process alone, as workers take longer to start.

    Raises:
        LookupError: a sentinel is not in its table.
    """
    entry = study(name)
    with patch.dict(os.environ, LOKY_MAX_CPU_COUNT="1"):
        now = entry.again() if entry.again else {}
    for table, rows in entry.sentinels.items():
        if lacking := set(rows) - now[table].rows.keys():
            raise LookupError(f"{name}, {table}: no row {', '.join(sorted(lacking))}")
    return list(differences(data_file.read(name).measured.tables, now))


def told(moved: Sequence[Difference]) -> str:
    return f"{len(moved)} numbers have moved" if moved else "no number has moved beyond its tolerance"


def _cpu_seconds() -> float:
    """Of this process and of its children that have ended."""
    return sum(os.times()[:4])


if __name__ == "__main__":
    script(main)

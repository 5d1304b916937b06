"""The pages of the documentation that are computed.

    python -m docs.studies --list           # which are stale, and because of which files
    python -m docs.studies                  # makes those that are stale
    python -m docs.studies results goals    # makes these, stale or not

Stopped, it goes on with the next call: pages that are made stay, and commands that can go on do so.
"""

import argparse
import json
import shlex
import shutil
import sys
from collections.abc import Iterator, Sequence
from importlib import import_module
from pathlib import Path

from docs.studies.digests import dependencies, reasons, record, why_stale
from docs.studies.imports import ROOT
from docs.studies.pages import PAGES, Page
from driveline.harness.base.atomic_files import complete
from driveline.harness.base.interruption import script
from driveline.harness.commands.cli import main as driveline
from driveline.harness.loop.places import COMPARATORS

DOCS = ROOT / "docs"
RESULTS = ROOT / "results" / "docs"

STOPPED = 128
"""Exit codes from here on are those of commands that were stopped."""

SHOWN = 3
"""Files that are named; more are counted."""


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m docs.studies", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("pages", nargs="*", metavar="PAGE", help="one of those of --list (default: all that are stale)")
    parser.add_argument("--list", action="store_true", help="makes nothing")
    args = parser.parse_args(arguments)
    if unknown := set(args.pages) - PAGES.keys():
        parser.error(f"there is no page {', '.join(sorted(unknown))}; there are {', '.join(PAGES)}")
    pages = [PAGES[name] for name in args.pages or PAGES]
    if args.list:
        print("\n".join(line for page in pages for line in told(page)))
        return 0
    return make_all([page for page in pages if page.steps and (args.pages or why_stale(page))])


def told(page: Page) -> Iterator[str]:
    """What --list says of a page."""
    if not (files := why_stale(page)):
        yield f"{page.name}: up to date"
        return
    more = f" and {len(files) - SHOWN} more" if len(files) > SHOWN else ""
    yield f"{page.name}: stale: {', '.join(files[:SHOWN])}{more}"
    if page.made_by:
        yield f"    made by `{page.made_by}`"
    if reason := reasons().get(page.name):
        yield f"    {reason}"


class StepError(Exception):
    """A step has failed; the text says which."""


def make_all(pages: Sequence[Page]) -> int:
    """Makes pages, one after the other; returns 1 if one could not be made, else 0."""
    code = 0
    if any(page.fmus for page in pages):
        run("driveline build", ROOT)
        run(f"driveline build {shlex.join(COMPARATORS)}", ROOT)
    for k, page in enumerate(pages, 1):
        print(f"[{k}/{len(pages)}] {page.name}", flush=True)
        try:
            how = ", ".join(make(page)) or "came out the same"
        except StepError as failure:
            how, code = f"not made: {failure}", 1
        print(f"[{k}/{len(pages)}] {page.name}: {how}", flush=True)
    return code


def make(page: Page) -> list[str]:
    """Makes a page; returns the files in docs that have changed."""
    made_from, folder = dependencies(page), RESULTS / page.name
    begin(folder, made_from)
    for step in page.steps:
        run(step, folder, page.allowed)
    changed = publish(page, folder)
    record(page, made_from)
    shutil.rmtree(folder)
    return changed


def begin(folder: Path, made_from: dict[str, str]) -> None:
    """The folder as it was left, if that was made from the same; else an empty one."""
    before, now = folder / "made_from.json", json.dumps(made_from)
    if not before.exists() or before.read_text(encoding="utf-8") != now:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        before.write_text(now, encoding="utf-8")


def run(step: str, folder: Path, allowed: int = 0) -> None:
    """Runs a step; one that is stopped ends all with its exit code.

    Raises:
        StepError: it has failed.
    """
    program, *arguments = (word.replace("OUT", str(folder)) for word in shlex.split(step))
    if program != "driveline":
        import_module(program).make(folder, *arguments)
    elif (code := driveline(arguments)) not in (0, allowed):
        if code >= STOPPED:
            sys.exit(code)
        raise StepError(f"{step}: exit code {code}")


def publish(page: Page, folder: Path) -> list[str]:
    """Puts what was made into docs, and removes figures that are not made any more; returns what has changed."""
    changed = []
    for place, made in page.writes.items():
        found = {_place(place, path): path for path in folder.glob(made)}
        if not found:
            raise StepError(f"no {made}")
        gone = set(DOCS.glob(place)) - found.keys()
        for path in gone:
            path.unlink()
        new = [path for path, its in found.items() if not path.exists() or path.read_bytes() != its.read_bytes()]
        for path in new:
            with complete(path) as unfinished:
                shutil.copyfile(found[path], unfinished)
        changed += [path.relative_to(ROOT).as_posix() for path in sorted({*gone, *new})]
    return changed


def _place(place: str, path: Path) -> Path:
    return DOCS / Path(place).with_name(path.name if "*" in place else Path(place).name)


if __name__ == "__main__":
    script(main)

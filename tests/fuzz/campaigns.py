"""Campaigns that are stopped anywhere, whose files something has damaged, or whose code has changed meanwhile."""

import json
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from random import Random
from unittest.mock import patch

from driveline.harness.simulation import case_archive, provenance
from driveline.harness.simulation.case_archive import Table, resumable
from tests.fuzz.damage import spoiled_text
from tests.fuzz.target import Attempt, Unclean, target
from toolground.errors import UserError

TABLE: Table[int, float] = Table(
    ["case", "answer"], lambda case, answer: [case, answer], lambda row: (int(row[0]), float(row[1])), "two numbers"
)
CASES = range(12)


class Killed(BaseException):
    """The process ends without a word."""


@target(
    "campaigns that are killed anywhere and continued after their records, lines or code have become others",
    "the answers of one code and all that distinguishes it, or a line that refuses to go on",
    short=40,
    long=20_000,
)
def attempts(folder: Path) -> Iterator[Attempt]:
    path = folder / "answers.csv"
    record = path.with_suffix(".json")

    def run(seed: int, code: float, until: int) -> dict[int, float]:
        """Of a campaign whose answers are those of its code."""
        with (
            patch.object(case_archive, "digest_behind", lambda _: f"sha256:{code}"),
            patch.object(provenance, "commit", lambda: None),  # git takes most of the time
            resumable(path, TABLE, record, {"seed": seed}, {}, []) as made,
        ):
            for case in CASES:
                if case == until:
                    raise Killed
                if case not in made.archive:
                    made.archive[case] = code * (case + seed)
            return dict(made.archive)

    def attempt(random: Random) -> str:
        for each in folder.iterdir():
            each.unlink()
        first, second = ((random.randrange(2), 1.0 + random.randrange(2)) for _ in range(2))
        with suppress(Killed):
            run(*first, random.choice(CASES))
        spoiled = random.choice([None, record, path])
        if spoiled is record:
            record.write_text(spoiled_text(record.read_text(), random), encoding="utf-8", errors="replace")
        elif spoiled is path:  # a line that was torn
            path.write_bytes(path.read_bytes()[: -random.randrange(1, 6)])
        try:
            found = run(*second, len(CASES))
        except UserError as refusal:
            if not str(refusal).isprintable():
                raise Unclean(f"{refusal}") from refusal
            return "refused in one line"
        seed, code = second
        if found != {case: code * (case + seed) for case in CASES}:
            raise Unclean(f"{first} continued as {second}, {spoiled}: {found}")
        if json.loads(record.read_text())["run"]["code"] != f"sha256:{code}":
            raise Unclean("its record tells of other code")
        return "goes on"

    yield attempt

"""Files of the cache that something has damaged: the compiled libraries that campaigns load, and their digests."""

from collections.abc import Iterator
from pathlib import Path
from random import Random
from shutil import copyfile

from driveline.fmus.catalogue import FMUS
from fmublocks.native.lanes import build_lanes
from tests.fuzz.damage import spoiled_bytes
from tests.fuzz.target import Attempt, Unclean, target
from toolground.lanes_here import lanes_here
from toolground.user_cache import kept


@target(
    "damaged files of the cache and digests beside them",
    "made again where a byte is another one",
    short=200,
    long=100_000,
)
def attempts(folder: Path) -> Iterator[Attempt]:
    sound, path = folder / "sound.so", folder / "cache" / "key" / "library.so"
    build_lanes(FMUS["MotorTorqueLoop"], lanes_here() or 4, sound)
    whole = sound.read_bytes()

    def attempt(random: Random) -> str:
        made: list[Path] = []

        def make(unfinished: Path) -> None:
            made.append(unfinished)
            copyfile(sound, unfinished)

        kept(path, make)
        made.clear()
        place = random.choice([path, path.with_name(f"{path.name}.digest")])
        before = place.read_bytes()
        place.write_bytes(spoiled_bytes(before, random))
        is_damaged = place.read_bytes() != before
        if kept(path, make).read_bytes() != whole:
            raise Unclean(f"{place.name} is taken as it was not made")
        if bool(made) != is_damaged:
            raise Unclean(f"{place.name} was made again {len(made)} times")
        return "made again" if made else "taken"

    yield attempt

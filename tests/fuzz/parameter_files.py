"""Vehicle files."""

from collections.abc import Iterator
from pathlib import Path
from random import Random

from driveline.fmus.building.parameter_files import read_vehicle
from driveline.fmus.errors import ParameterFileError
from tests.fuzz.damage import ODD, spoiled_bytes, spoiled_text
from tests.fuzz.target import Attempt, Unclean, target

SOUND = "# a car\nJ_1 = 0.09\nJ_2 = 0.45\nC = 210.0\nphi_B = 0.06\ni = 10.5\nm = 2200\nr = 0.34\n"


def other_value(text: str, random: Random) -> str:
    lines = text.splitlines()
    k = random.randrange(1, len(lines))
    lines[k] = f"{lines[k].partition('=')[0]}= {random.choice((*ODD, '[1.0]', '{a = 1}', '1e-9', '1979-05-27'))}"
    return "\n".join(lines)


@target(
    "damaged vehicle files",
    "the parameters, or a line for each entry that is refused",
    short=100,
    long=100_000,
)
def attempts(folder: Path) -> Iterator[Attempt]:
    def attempt(random: Random) -> str:
        path = folder / "car.toml"
        content = random.choice((other_value, spoiled_text))(SOUND, random).encode("utf-8", "surrogatepass")
        path.write_bytes(spoiled_bytes(content, random) if random.random() < 0.2 else content)
        try:
            read_vehicle(path)
        except ParameterFileError as refusal:
            if not all(line.isprintable() and len(line) < 400 + len(str(path)) for line in str(refusal).splitlines()):
                raise Unclean(f"{path.read_bytes()!r}: {refusal}") from refusal
            return "refused"
        return "taken"

    yield attempt

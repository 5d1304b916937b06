"""Drafts which variables of somebody else's FMU are those that the loop exchanges with a place: by names, causality and
unit. What is not sure stands behind a # and does not count until you take that away, what is missing is named; where
nothing fits at all, the exit code is 2. The file is what --map of the other commands takes. Names of one FMU of several
stand in a table with the name of its file, as [their_car].

examples:
  driveline map their_car.fmu --place plant --output theirs.toml
  driveline compare --plant their_car.fmu --map theirs.toml
"""

from pathlib import Path

from toolground.arguments import option, positional, record
from toolground.errors import UserError
from toolground.printing import JsonPrinting

from ..loop.places import OPTIONAL, PLACES
from .options import Replacing, file_of, write_toml


@record
class Arguments(Replacing, JsonPrinting):
    fmu: Path = positional("the FMU", Path, "FILE.fmu")
    place: str = option(
        "plant", "where it stands in the loop: %(choices)s (default: %(default)s)", choices=tuple(PLACES)
    )
    output: Path | None = file_of("of the mapping (default: it is printed)")


def run(args: Arguments) -> int:
    from fmuloop.interface import Interface

    from ..exchange.mapping_draft import NO_UNIT, as_toml, draft, missing

    proposals = draft(Interface(args.fmu), args.place)
    needed = [each for each in proposals if each.port.name not in OPTIONAL]
    if all(each.theirs is None for each in needed):
        names = ", ".join(each.port.variable for each in needed)
        raise UserError(f"{args.fmu}: nothing in it fits a {args.place}, which has {names}")
    text = as_toml(proposals, args.fmu.name, args.place)
    if args.output is not None:
        write_toml(text, args.output, args.replace)
        args.say(f"written: {args.output}")
        if guessed := [each.port.variable for each in proposals if each.theirs and not each.sure]:
            args.say(f"not sure, and behind a # until you have read them: {', '.join(guessed)}")
        if silent := [each.port.variable for each in proposals if each.theirs and not each.has_unit]:
            args.say(f"{NO_UNIT} those of the loop: {', '.join(silent)}")
        for line in missing(proposals):
            args.say(line)
    elif not args.silent:
        print(text, end="")
    args.document(
        {each.port.name: {"theirs": each.theirs, "sure": each.sure, "unit": each.port.unit} for each in proposals}
    )
    return 0

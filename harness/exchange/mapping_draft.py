"""A draft of the mapping of somebody else's FMU: which of its variables the loop means by the names of a place.

Names are taken apart into words (`tqMotAct`: torque, motor, actual), which are compared with those of the loop;
causality and unit must fit.
"""

from collections.abc import Iterator, Mapping, Sequence
from json import dumps
from typing import NamedTuple

from fmpy.model_description import ModelVariable

from fmuloop.interface import Interface, unit_of
from fmuloop.system import Port, System
from toolground.known_names import words_of
from toolground.unit_conversion import converts

from ..loop.places import CONNECTIONS, INPUTS, OPTIONAL, OUTPUTS, PARAMETERS

WORDS = {
    "torque": "t tq trq tau torque m mom moment drehmoment",
    "speed": "n w omega om spd speed vel velocity rpm drehzahl phidot",
    "motor": "1 mot motor em emot rotor e engine",
    "wheel": "2 whl wheel wheels rad rim tyre tire",
    "brake": "brk brake brakes brems bremse",
    "gear": "gear shaft gearbox getriebe halfshaft axle driveshaft",
    "body": "v vx ax veh vehicle car chassis body fzg",
    "acceleration": "a acc accel acceleration",
    "left": "l left li fl",
    "right": "r right re fr",
    "start": "0 init initial start",
    "slope": "slope grade gradient incline road",
    "demand": "driver demand req request cmd command des desired soll pedal",
    "reference": "ref reference set setpoint",
    "measured": "meas measured act actual ist sensor",
    "estimate": "est estimate estimated hat",
    "received": "can bus rx received",
    "valid": "valid ok flag validity",
    "counter": "counter cnt",
    "enable": "enable enabled on active activate",
    "seed": "seed",
}
"""Words by how names abbreviate them."""

MEANINGS = {abbreviation: word for word, texts in WORDS.items() for abbreviation in texts.split()}

OF_BODY = {"v": "speed", "vx": "speed", "ax": "acceleration"}
"""Letters that mean the body and a quantity at once."""

LEAST = 0.5
"""Share of common words from which a variable is proposed; all must be common for it to be sure."""


NO_UNIT = "the FMU tells no unit, taken as"
NOT_SURE = "NOT SURE: take the first # away if it is"


class Proposal(NamedTuple):
    """What a name of the loop may be.

    Attributes:
        port: of the loop.
        theirs: the name in the FMU; None: nothing fits.
        sure: whether all words are the same and no other variable has them.
        has_unit: whether the FMU tells its unit.
    """

    port: Port
    theirs: str | None
    sure: bool
    has_unit: bool = True


def draft(interface: Interface, place: str) -> list[Proposal]:
    """A proposal for each name of a place of the loop; no variable is proposed twice."""
    candidates: dict[str, list[tuple[float, str]]] = {}
    ports = {port.name: (port, causality) for causality, port in _ports(place)}
    for name, (port, causality) in ports.items():
        ours = words(port.variable)
        fitting = [v for v in interface.of_causality(causality) if _fits(v, port.unit)]
        candidates[name] = sorted(((_alike(ours, words(v.name)), str(v.name)) for v in fitting), reverse=True)
    proposals, taken = {}, set[str]()
    for name in sorted(ports, key=lambda name: -candidates[name][0][0] if candidates[name] else 0.0):
        free = [(share, theirs) for share, theirs in candidates[name] if theirs not in taken and share >= LEAST]
        theirs = free[0][1] if free else None
        sure = bool(free) and free[0][0] == 1.0 and [share for share, _ in free].count(1.0) == 1
        taken |= {theirs} if theirs else set()
        proposals[name] = Proposal(ports[name][0], theirs, sure)
    drafts = (_last_of_its_kind(name, ports, proposals, candidates) for name in ports)
    return [of._replace(has_unit=not of.theirs or bool(unit_of(interface.variables[of.theirs]))) for of in drafts]


def _last_of_its_kind(
    name: str,
    ports: Mapping[str, tuple[Port, str]],
    proposals: Mapping[str, Proposal],
    candidates: Mapping[str, Sequence[tuple[float, str]]],
) -> Proposal:
    """The proposal for a name; where it alone of a causality is left, and one variable that fits, that one."""

    def unmatched(causality: str) -> list[str]:
        return [n for n, (_, of) in ports.items() if of == causality and n not in OPTIONAL and not proposals[n].theirs]

    taken = {proposal.theirs for proposal in proposals.values()}
    fitting = [theirs for _, theirs in candidates[name] if theirs not in taken]
    alone = unmatched(ports[name][1]) == [name] and len(fitting) == 1
    return proposals[name]._replace(theirs=fitting[0]) if alone else proposals[name]


def as_toml(proposals: list[Proposal], file: str, place: str) -> str:
    """The mapping as a file: what is not sure is a comment until it has been read, what is missing stands below."""
    lines = [f"# {file} in the place of the {place}: names of the loop, and what they are in the FMU", f"[{place}]"]
    for proposal in proposals:
        if proposal.theirs is not None:
            unit = f"in {proposal.port.unit}" if proposal.port.unit else ""
            if unit and proposal.port.unit != "1" and not proposal.has_unit:
                unit = f"{NO_UNIT} {proposal.port.unit}"
            notes = ", ".join(note for note in (unit, "" if proposal.sure else NOT_SURE) if note)
            entry = f"{'' if proposal.sure else '# '}{proposal.port.variable} = {dumps(proposal.theirs)}"
            lines.append(entry + (f"  # {notes}" if notes else ""))
    lines += [f"# {line}" for line in missing(proposals)]
    return "\n".join(lines) + "\n"


def missing(proposals: Sequence[Proposal]) -> Iterator[str]:
    """What nothing fits, in a line each: without what no run goes, and what is optional."""
    for needed, what in ((True, "missing, and no run goes without"), (False, "missing, but optional")):
        lacking = (proposal.port for proposal in proposals if proposal.theirs is None)
        if names := [port.variable for port in lacking if (port.name not in OPTIONAL) == needed]:
            yield f"{what}: {', '.join(names)}"


def words(name: str) -> frozenset[str]:
    """The words of a name: `tqMotAct` has torque, motor and measured."""
    parts = words_of(name)
    meant = {MEANINGS.get(part, part) for part in parts}
    return frozenset(meant | {OF_BODY[part] for part in parts if part in OF_BODY})


def _alike(ours: frozenset[str], theirs: frozenset[str]) -> float:
    return len(ours & theirs) / len(ours | theirs)


def _fits(variable: ModelVariable, unit: str | None) -> bool:
    theirs = unit_of(variable)
    return unit is None or (variable.type == "Real" and (not theirs or converts(theirs, unit)))


def _ports(place: str) -> Iterator[tuple[str, Port]]:
    """Causality and name of what the loop exchanges with a place."""
    for causality, ports in System({}, CONNECTIONS, INPUTS, PARAMETERS, OUTPUTS).ports.items():
        for port in ports:
            if port.name.startswith(f"{place}."):
                yield causality, port

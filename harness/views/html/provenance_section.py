"""What made a report, as lines for people."""

from collections.abc import Iterator, Mapping
from typing import Any


def facts(content: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Names and values.

    Args:
        content: as `harness.simulation.provenance.content` gives it.
    """
    return [
        ("program", str(content["program"])),
        ("commit", str(content["commit"] or "not of a checkout")),
        ("command line", str(content["command_line"])),
        *_fmus(content["fmus"]),
        *((f"input {path}", digest) for path, digest in content["inputs"].items()),
        *_flat(content["run"], ()),
    ]


def _fmus(plants: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    for plant, fmus in plants.items():
        for name, fmu in fmus.items():
            yield f"FMU {name} ({plant})", f"{fmu['file']} {fmu['digest']}"


def _flat(value: Any, names: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """What was set, a line for each value; what was not is left out."""
    if isinstance(value, Mapping):
        for name, each in value.items():
            if name not in ("fmus", "start_values"):
                yield from _flat(each, (*names, str(name)))
    elif value not in (None, "", [], ()):
        yield " ".join(names), ", ".join(map(str, value)) if isinstance(value, list) else str(value)

"""Reading a model description that anybody may have written: what a run relies on is there and is a number."""

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from math import isfinite, isnan
from pathlib import Path
from typing import Any, cast
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import fmpy
from fmpy.model_description import ModelDescription

from toolground.file_limits import DEEPEST_XML, LONGEST_ATTRIBUTE, MOST_PARTS
from toolground.plain_text import plain

from .errors import WiringError
from .fmu_archive import described
from .limits import USUAL_LIMITS, Limits

IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z_0-9]*")

VERSION = re.compile(r"2\.0|3\.0(\.[0-9]+)?")

WHOLE = re.compile(r"[+-]?[0-9]{1,19}")


STEPPING = ("CoSimulation",)
"""The kind of FMU that runs in our loops."""

KINDS = {
    "CoSimulation": "co-simulation",
    "ModelExchange": "model exchange",
    "ScheduledExecution": "scheduled execution",
}
"""Elements of the kinds that there are, and what the standards call these."""

OURS = {"Float64": "Real", "Int32": "Integer"}
"""Types of FMI 3.0 by the names of FMI 2.0."""

REFERENCES = ("dependencies", "dependenciesKind", "clocks")
"""Attributes that are lists."""

MOST_KEPT = 16
"""Descriptions."""


def read(path: Path, limits: Limits = USUAL_LIMITS, kinds: Sequence[str] = STEPPING) -> ModelDescription:
    """The model description of an FMU, with our names of types; one that was read before is not parsed again.

    Args:
        kinds: of FMUs that are taken, of `KINDS`.

    Raises:
        WiringError: it is not one of an FMU of these kinds, of FMI 2.0 or 3.0, or what a run relies on is missing or
            is no number.
    """
    if not path.is_file():
        raise WiringError(f"there is no FMU {path}")
    return _parsed(described(path, limits), path, tuple(kinds))


@lru_cache(MOST_KEPT)
def _parsed(text: bytes, path: Path, kinds: Sequence[str]) -> ModelDescription:
    root = _root(text, path)
    version = root.get("fmiVersion")
    if root.tag != "fmiModelDescription" or version is None or not VERSION.fullmatch(version):
        raise WiringError(f"{path} is of FMI {plain(version)}; known are FMI 2.0 and FMI 3.0")
    offered = [element for kind in kinds for element in root.findall(kind)]
    if not offered:
        others = [called for kind, called in KINDS.items() if root.find(kind) is not None]
        taken = " or ".join(KINDS[kind] for kind in kinds)
        raise WiringError(f"{path} is for {' and '.join(others) or 'nothing'} alone; it must be for {taken}")
    problems = list(_problems(root, offered))
    if problems:
        more = f" (and {len(problems) - 1} more)" if problems[1:] else ""
        raise WiringError(f"the model description of {path} cannot be used: {problems[0]}{more}")
    try:
        model = fmpy.read_model_description(str(path), validate=False)
    except Exception as error:  # fmpy raises bare exceptions
        reason = plain(error if type(error) is Exception else f"{type(error).__name__} {error}")
        raise WiringError(f"the model description of {path} cannot be read: {reason}") from error
    for variable in model.modelVariables if version != "2.0" else ():
        of_array = "array of " if variable.shape else ""
        cast(Any, variable).type = of_array + OURS.get(str(variable.type), str(variable.type))
    return model


def document_root(path: Path, limits: Limits) -> Element:
    """The model description of an FMU as it stands there.

    Raises:
        WiringError: there is none that can be read.
    """
    return _kept_root(described(path, limits), path)


def _root(text: bytes, path: Path) -> Element:
    try:
        parser = ElementTree.XMLParser(target=_Elements())
        parser.feed(
            text
        )  # at once: what comes piece by piece is looked at again from the beginning of a long attribute
        return parser.close()
    except Exception as error:  # what it raises depends on the encoding that the text claims to have
        raise WiringError(f"the model description of {path} cannot be read: {plain(error)}") from error


_kept_root = lru_cache(1)(_root)
"""Many rules look at one description."""


class _Elements(ElementTree.TreeBuilder):
    """Those of a text, in whatever encoding, that stands for itself: no entities, no other files; as many as the limits
    allow."""

    def __init__(self) -> None:
        super().__init__()
        self._parts = self._depth = 0

    def start(self, tag: Any, attrs: dict[Any, Any], /) -> Element:
        self._depth += 1
        self._parts += 1 + len(attrs)
        for name, text in attrs.items():
            if len(text) > LONGEST_ATTRIBUTE:
                raise ValueError(f"{plain(name)} has {len(text)} characters; {LONGEST_ATTRIBUTE} are allowed")
            if name in REFERENCES:
                self._parts += text.count(" ")
        if self._parts > MOST_PARTS:
            raise ValueError(f"it has more than {MOST_PARTS} elements, attributes and references")
        if self._depth > DEEPEST_XML:
            raise ValueError(f"it has more than {DEEPEST_XML} elements in one another")
        return super().start(tag, attrs)

    def end(self, tag: str, /) -> Element:
        self._depth -= 1
        return super().end(tag)

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        raise ValueError("it declares a document type, which FMI does not know")


def _problems(root: Element, offered: Iterable[Element]) -> Iterator[str]:
    fmi2 = root.get("fmiVersion") == "2.0"
    token = "guid" if fmi2 else "instantiationToken"
    if root.get(token) is None:
        yield f"fmiModelDescription has no {token}"
    for kind in offered:
        identifier = kind.get("modelIdentifier")
        if identifier is None:
            yield f"{kind.tag} has no modelIdentifier"
        elif not IDENTIFIER.fullmatch(identifier):
            yield f"modelIdentifier is {plain(identifier)!r}; it must be a name as in C"
    for experiment in root.findall("DefaultExperiment"):
        yield from _not_numbers(experiment, "DefaultExperiment", EXPERIMENT)
    variables = root.findall("ModelVariables/ScalarVariable" if fmi2 else "ModelVariables/*")
    for position, variable in enumerate(variables, start=1):
        yield from _of_variable(variable, position)
        if variable.get("name"):
            yield from _of_kind(variable) if fmi2 else _of_fmi3(variable)
    known = {variable.get("valueReference") for variable in variables}
    for unknown in root.iterfind("ModelStructure/*/Unknown" if fmi2 else "ModelStructure/*"):
        yield from _of_unknown(unknown, len(variables)) if fmi2 else _of_unknown_of_fmi3(unknown, known)


def _of_variable(variable: Element, position: int) -> Iterator[str]:
    name = variable.get("name")
    if not name:
        yield f"the variable number {position} has no name"
        return
    name = plain(name)
    if variable.get("valueReference") is None:
        yield f"{name} has no valueReference"
    yield from _not_numbers(variable, name, {"valueReference": _reference})


def _of_kind(variable: Element) -> Iterator[str]:
    name = plain(variable.get("name"))
    kinds = [child for child in variable if child.tag in NUMBERS]
    if len(kinds) != 1:
        yield f"{name} has {'more than one type' if kinds else 'no type'}"
    for kind in kinds:
        yield from _not_numbers(kind, name, NUMBERS[kind.tag])


def _of_fmi3(variable: Element) -> Iterator[str]:
    if variable.find("Dimension") is None:  # where a start is one number
        yield from _not_numbers(variable, plain(variable.get("name")), NUMBERS_OF_FMI3.get(variable.tag, {}))


def _of_unknown_of_fmi3(unknown: Element, known: Collection[str | None]) -> Iterator[str]:
    for attribute in ("valueReference", "dependencies"):
        for text in unknown.get(attribute, "").split():
            if text not in known:
                yield f"{attribute} of {plain(unknown.tag)} in ModelStructure is {plain(text)!r}, which no variable has"
    if unknown.get("valueReference") is None:
        yield f"{plain(unknown.tag)} in ModelStructure has no valueReference"


def _of_unknown(unknown: Element, count: int) -> Iterator[str]:
    for attribute in ("index", "dependencies"):
        for text in unknown.get(attribute, "").split():
            if not _whole(text, 1, count):
                yield f"{attribute} of an Unknown in ModelStructure is {plain(text)!r}; there are {count} variables"
    if unknown.get("index") is None:
        yield "an Unknown in ModelStructure has no index"


def _not_numbers(element: Element, name: str, numbers: Mapping[str, Callable[[str], bool]]) -> Iterator[str]:
    for attribute, is_one in numbers.items():
        text = element.get(attribute)
        if text is not None and not is_one(text):
            yield f"{attribute} of {name} is {plain(text)!r}, which is not a number that it can be"


def _real(text: str) -> bool:
    try:
        return "_" not in text and not isnan(float(text))
    except ValueError:
        return False


def _finite(text: str) -> bool:
    return _real(text) and isfinite(float(text))


def _above_zero(text: str) -> bool:
    return _finite(text) and float(text) > 0.0


def _whole(text: str, lowest: int = -(2**31), highest: int = 2**31 - 1) -> bool:
    return bool(WHOLE.fullmatch(text.strip())) and lowest <= int(text) <= highest


def _reference(text: str) -> bool:
    return _whole(text, 0, 2**32 - 1)


def _truth(text: str) -> bool:
    return text.strip() in ("true", "false", "0", "1")


EXPERIMENT: Mapping[str, Callable[[str], bool]] = {
    "startTime": _finite,
    "stopTime": _finite,
    "tolerance": _finite,
    "stepSize": _above_zero,
}
"""The attributes of DefaultExperiment, all numbers."""

NUMBERS: Mapping[str, Mapping[str, Callable[[str], bool]]] = {
    "Real": dict.fromkeys(("start", "min", "max"), _real) | {"nominal": _finite},
    "Integer": dict.fromkeys(("start", "min", "max"), _whole),
    "Enumeration": dict.fromkeys(("start", "min", "max"), _whole),
    "Boolean": {"start": _truth},
    "String": {},
}
"""The types of variables, and which of their attributes are numbers."""


NUMBERS_OF_FMI3: Mapping[str, Mapping[str, Callable[[str], bool]]] = {
    "Float64": NUMBERS["Real"],
    "Float32": NUMBERS["Real"],
    "Int32": NUMBERS["Integer"],
    "Enumeration": NUMBERS["Enumeration"],
    "Boolean": NUMBERS["Boolean"],
}
"""The types of variables of FMI 3.0 that a run knows, and Float32."""

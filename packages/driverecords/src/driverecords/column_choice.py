"""Which column of a file holds which quantity."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from shlex import quote

import numpy as np

from toolground.known_names import nearest
from toolground.plain_text import plain
from toolground.unit_conversion import converts, factor, known

from .clock_times import EXAMPLES
from .headings import key, last_part, split, without_brackets
from .quantities import BY_UNIT, OF_MANY, QUANTITIES, Aliases, example, is_of_another
from .source import Column, RecordingError, Source

NAMES_SHOWN = 3
"""Other names of a quantity that a message gives where none is found."""

Place = tuple[int, str | None]
"""Of a column in the file, and its unit."""


@dataclass(frozen=True)
class Choice:
    """A column that holds a quantity.

    Attributes:
        place: of the column in the file.
        unit: of the SI, into which `factor` turns its values.
        file_unit: the unit that they have in the file.
    """

    quantity: str
    column: Column
    place: int
    unit: str
    factor: float
    file_unit: str


@dataclass(frozen=True)
class Chooser:
    """Finds the columns of a file.

    Attributes:
        by_user: by quantity, the heading or name of the column in which somebody says it is, with or without a unit;
            a minus before it says that its sign is the other one.
    """

    source: Source
    names: Aliases
    by_user: Mapping[str, str]

    def needed(self, quantity: str) -> Choice:
        """The column of a quantity.

        Raises:
            RecordingError: there is none; several; one of a unit that is none of this quantity.
        """
        choice = self.choice(quantity)
        if choice:
            return choice
        raise self.absence([quantity])

    def missing(self, quantities: Iterable[str]) -> list[str]:
        """Those that no column holds; else as `needed`."""
        return [quantity for quantity in quantities if self.choice(quantity) is None]

    def absence(self, missing: Sequence[str]) -> RecordingError:
        """What to say of quantities that no column holds."""
        examples = ", ".join(example(quantity, self.names) for quantity in missing)
        # all at once: it took a try for each column that was not there
        if missing[1:]:
            names = plain(", ".join(column.name for column in self.source.columns))
            which = " or ".join(missing)
            return RecordingError(
                f"{self.source.headings}: no column {examples}; the file has: {names}",
                f"; --column QUANTITY=HEADING says which one is {which}",
            )
        others = " or ".join(self.names[missing[0]][1 : 1 + NAMES_SHOWN])
        known = f" (other names are {others})" if others else ""
        return RecordingError(
            f"{self.source.headings}: no column {examples}{known}; {self._nearest(self.names[missing[0]][0])}",
            f"; --column {missing[0]}=HEADING says which one it is",
        )

    def _nearest(self, name: str) -> str:
        """What to say of a name that no column has."""
        return plain(nearest(name, [column.name for column in self.source.columns], every="the file has"))

    def choice(self, quantity: str) -> Choice | None:
        """The column of a quantity, None if there is none; else as `needed`."""
        if quantity in self.by_user:
            return self._named_by_user(quantity, self.by_user[quantity])
        places = self._meant(quantity)
        if not places:
            return None
        return self._only(quantity, places[:1] if self._each_has_its_own(quantity, places) else places, 1.0)

    def times(self) -> list[Choice]:
        """The columns of time: several if each holds for those behind it, up to the next.

        Raises:
            RecordingError: as of `needed`.
        """
        meant = [] if "time" in self.by_user else self._meant("time")
        several = self._each_has_its_own("time", meant)
        return [self._only("time", [place], 1.0) for place in meant] if several else [self.needed("time")]

    def _each_has_its_own(self, quantity: str, columns: Sequence[Place]) -> bool:
        """Whether columns are times of one name, each before others."""
        places = [*(place for place, _ in columns), len(self.source.columns)]
        names = {key(self.source.columns[place].name) for place, _ in columns}
        return quantity == "time" and len(names) == 1 and bool((np.diff(places) > 1).all())

    def _meant(self, quantity: str) -> Sequence[Place]:
        """The columns that may hold a quantity, by their names and units."""
        sure, open_ = self._named(self.names[quantity]), self._named(BY_UNIT.get(quantity, ()))
        unitless = [(place, unit) for place, unit in sure if unit is None]
        # of `Speed [km/h]` and `Speed [rpm]` the unit tells which is that of the vehicle
        return _fitting(quantity, sure) or unitless or _fitting(quantity, open_) or sure or self._below(quantity)

    def _named(self, names: Sequence[str]) -> list[Place]:
        """The columns that have one of the names."""
        keys = {key(name) for name in names}
        return [(place, unit) for place, name, unit in self._readings() if key(name) in keys]

    def _below(self, quantity: str) -> list[Place]:
        """The columns that have one of its names behind a path."""
        keys = {key(name) for name in self.names[quantity]} - OF_MANY
        return [
            (place, unit)
            for place, name, unit in self._readings()
            if key(last_part(name)) in keys and not is_of_another(name.removesuffix(last_part(name)))
        ]

    def _readings(self) -> Iterator[tuple[int, str, str | None]]:
        """Of each column its place, and name and unit as it can be understood."""
        for place, column in enumerate(self.source.columns):
            for name, unit in _readings(column):
                yield place, name, unit

    def _named_by_user(self, quantity: str, text: str) -> Choice:
        sign = -1.0 if text.startswith("-") else 1.0
        heading = text.removeprefix("-").strip()
        columns = self.source.columns
        places = [(k, _readings(column)[-1][1]) for k, column in enumerate(columns) if column.heading == heading]
        name, unit = split(heading)
        places = places or [
            (place, unit or own)
            for place, name_read, own in self._readings()
            if key(name_read).removeprefix("-") == key(name)
        ]
        if not places:
            raise RecordingError(
                f"{self.source.headings}: no column {plain(heading, 60)}, which --column gives for {quantity}; "
                f"{self._nearest(name)}"
            )
        return self._only(quantity, places, sign)

    def _only(self, quantity: str, places: Sequence[Place], sign: float) -> Choice:
        columns = self.source.columns
        if len(places) > 1:
            raise doubled(self.source, quantity, [columns[k].heading for k, _ in places])
        place, unit = places[0]
        si, factor = self._factor(quantity, columns[place], unit)
        return Choice(quantity, columns[place], place, si, sign * factor, unit or si)

    def _factor(self, quantity: str, column: Column, unit: str | None) -> tuple[str, float]:
        """Unit of the SI and the factor to it."""
        declared = QUANTITIES[quantity]
        mended = f"--column {quantity}={quote(f'{column.name} [{declared.file_unit}]')}"
        if unit is None and declared.unit != "1":
            # a date of a form that is not read was asked for a unit, and with one was said to be no number
            clock = f" (a time of day needs none, such as {EXAMPLES})" if quantity == "time" else ""
            raise RecordingError(
                f"{self.source.headings}: {column.heading} has no unit; write one into the heading, as in "
                f"{example(quantity, self.names)}{clock}",
                f", or give it with {mended}",
            )
        try:
            return si_of(quantity, unit or "1")
        except ValueError as reason:
            raise RecordingError(
                f"{self.source.headings}: {column.heading} {plain(reason, 200)}, as in the heading "
                f"{example(quantity, self.names)}",
                f"; {mended} gives another unit, --column {quantity}=HEADING another column",
            ) from reason


def si_of(quantity: str, unit: str) -> tuple[str, float]:
    """The unit of the SI that a quantity has where a file has it in a unit, and the factor to it.

    Raises:
        ValueError: it does not convert; the message is to stand after the name of the column.
    """
    declared = QUANTITIES[quantity]
    if declared.also and converts(unit, declared.also):
        return declared.also, factor(unit, declared.also)
    try:
        return declared.unit, factor(unit, declared.unit)
    except ValueError as reason:
        raise ValueError(f"{reason}; wanted is {declared.unit} or what converts into it") from reason


def _fitting(quantity: str, places: Sequence[Place]) -> list[Place]:
    """Those whose unit is one of the quantity."""
    units = (QUANTITIES[quantity].unit, QUANTITIES[quantity].also)
    return [place for place in places if any(place[1] and unit and converts(place[1], unit) for unit in units)]


def _readings(column: Column) -> list[tuple[str, str | None]]:
    """Name and unit as the column can be understood, as they stand first."""
    others = without_brackets(column.name) if column.unit is None else []
    return [(column.name, column.unit), *((name, unit) for name, unit in others if known(unit))]


def doubled(source: Source, quantity: str, headings: Sequence[str]) -> RecordingError:
    """What to say of several columns that could hold a quantity."""
    # no option tells two of the same heading apart
    distinct = [heading for heading in headings if headings.count(heading) == 1]
    if not distinct:
        called = f"{len(headings)} columns are called {headings[0]}; rename all but one in the file"
        return RecordingError(f"{source.headings}: {called}")
    return RecordingError(
        f"{source.headings}: {' and '.join(headings)} could each be {quantity} ({QUANTITIES[quantity].meaning})",
        f"; say which one is meant, as in --column {quantity}={quote(distinct[0])}",
    )

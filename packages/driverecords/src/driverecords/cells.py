"""What stands in a cell of a text: a number, nothing, or something else."""

import re
from collections.abc import Sequence
from math import isfinite, nan

import numpy as np

from toolground.written_numbers import real

SIGNS = str.maketrans(
    dict.fromkeys("−–‒—‐‑⁻﹣－\N{SOFT HYPHEN}", "-")
    | dict.fromkeys("\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}\N{THIN SPACE}\N{FIGURE SPACE}", " ")
    | dict.fromkeys("“”„‟", '"')
    | {"＋": "+"}
)
"""Of a true minus sign, and what stands for one; of blanks and quotes of typesetters."""

NEGATIVE = re.compile(r"\((?P<bracketed>[\d.,]+)\)|(?P<before>[\d.,]+)-|-\s+(?P<apart>[\d.,]+)|\+\s+(?P<plus>[\d.,]+)")
"""As accountants and machines of theirs write it, and signs that stand apart."""

WORDS = """
    - -- --- ---- . ? ?? ??? # na n/a n.a. n.a nan -nan +nan nan(ind) -nan(ind) null (null) <null> \\n <na> nat none nil
    nv n/v k.a. void invalid missing <missing> undefined undef n.def. unavailable sna nodata no_data ungültig
    --.- -.- .. err error fehler bad timeout overflow ovr #ovr #inv
    #n/a #na #nv #div/0! offline novalue no_value not_available
"""

PHRASES = "no data|not available|no value|signal not available|not a number|k. a.|bad input|i/o timeout"

EMPTY = frozenset(("", *WORDS.split(), *PHRASES.split("|")))
"""What loggers and spreadsheets write where there is no value, in small letters."""

SPELLINGS = sorted({spelling for word in EMPTY for spelling in (word, word.upper(), word.title(), word.capitalize())})
"""Of these words, for a parser that looks for them letter by letter."""

# `1.#QNAN00` is of the C of Microsoft, whatever tool was built with it
NO_NUMBER = re.compile(r"[+-]?(1\.#(qnan|snan|ind|nan)0*|nan\(\w*\))|#\w+[!?]|[-.,#*]+")
"""As libraries of C print it, errors of spreadsheets, and what displays show."""

NUMBER = re.compile(
    # an exponent with D needs its sign, which Fortran always writes: 1D2 may be anything
    r"[+-]?(\d+(?:[.,]\d*)?|[.,]\d+|\d{1,3}([.,' ’]\d{3})+([.,]\d*)?)(e[+-]?\d+|d[+-]\d+)?",
    re.ASCII | re.IGNORECASE,
)

GROUPED = {
    ".": re.compile(r"[+-]?[1-9]\d{0,2}(?:([,' ’])\d{3})(?:\1\d{3})*(\.\d*)?", re.ASCII),
    ",": re.compile(r"[+-]?[1-9]\d{0,2}(?:([.' ’])\d{3})(?:\1\d{3})*(,\d*)?", re.ASCII),
}
"""Numbers with a mark between thousands, by the decimal."""

THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}([.,])\d{3}(\1\d{3})*", re.ASCII)
"""Numbers that are whole in one country and have decimals in another."""

NO_DIGITS = str.maketrans("", "", "0123456789")

TRUTHS = {"true": 1.0, "false": 0.0}
"""Of a column that has nothing else."""


TEXT = re.compile(r"""=?(["'])(?P<inner>.*)\1|'(?P<marked>[^']*)""", re.DOTALL)
"""How spreadsheets write what is to stay a text: `="0.5"`, `'0.5'` and `'0.5`."""


def cleaned(cell: str) -> str:
    """Without blanks and quotes around it, and with plain signs."""
    text = unquoted(cell.translate(SIGNS).strip())
    if match := NEGATIVE.fullmatch(text):
        return ((match["plus"] and "+") or "-") + match[match.lastgroup or 0]
    return text


def unquoted(text: str) -> str:
    """What stands between the quotes."""
    match = TEXT.fullmatch(text)
    return (match["inner"] or match["marked"] or "").strip() if match else text


def is_number(cell: str) -> bool:
    """Whether it is a number in any of the forms that are read."""
    return NUMBER.fullmatch(cleaned(cell)) is not None


def is_missing(cell: str) -> bool:
    """Whether it says that there is no value."""
    text = cleaned(cell).casefold()
    return text in EMPTY or NO_NUMBER.fullmatch(text) is not None


def decimal_of(*columns: Sequence[str]) -> str:
    """Point or comma: what most numbers have last. A mark before three digits counts where there is no other: as one of
    thousands in a column that has whole numbers below thousand without."""
    there = [[text for text in map(cleaned, cells) if NUMBER.fullmatch(text)] for cells in columns]
    sure = [text for texts in there for text in texts if not THOUSANDS.fullmatch(text)]
    # 36,52 and 36.52 are sure; 1.520 may be a height of 1520 m in a German file
    commas, points = (sum(text.rfind(mark) > text.rfind(other) for text in sure) for mark, other in (",.", ".,"))
    if commas != points:
        return "," if commas > points else "."
    for texts in there:
        marks = [text.translate(NO_DIGITS)[-1:] for text in texts if THOUSANDS.fullmatch(text)]
        whole = [text.lstrip("+-") for text in texts if not THOUSANDS.fullmatch(text)]
        grouped = bool(whole) and all(len(text) < 4 for text in whole)
        commas += sum((mark == ",") != grouped for mark in marks)
        points += sum((mark == ".") != grouped for mark in marks)
    return "," if commas > points else "."


def numbers(cells: Sequence[str], decimal: str) -> tuple[np.ndarray, dict[int, str]]:
    """The numbers of a column, NaN where there is none, and what stands in the place of those that cannot be read."""
    known = {cell: _number(cell, decimal) for cell in set(cells)}
    flags = {cell: TRUTHS.get(cell.strip().casefold()) for cell, value in known.items() if value is None}
    if flags and None not in flags.values() and all(value is None or value != value for value in known.values()):
        known |= flags
    other, mark = (".", "comma") if decimal == "," else (",", "point")
    unreadable = {
        k: f"{cell} (the decimal of this file is a {mark})" if other in cell and is_number(cell) else cell
        for k, cell in enumerate(cells)
        if known[cell] is None
    }
    return np.array([nan if (value := known[cell]) is None else value for cell in cells], dtype=float), unreadable


def _number(cell: str, decimal: str) -> float | None:
    """The number, NaN where the cell says that there is none, None if it is something else."""
    if is_missing(cell):
        return nan
    text = cleaned(cell)
    if match := GROUPED[decimal].fullmatch(text):
        text = text.replace(match[1], "")
    if decimal == ",":
        # a point among decimal commas may part thousands or decimals, so it is refused
        if "." in text:
            return None
        text = text.replace(",", ".")
    value = real(re.sub("[dD](?=[+-])", "e", text))  # as Fortran writes double precision
    return value if value is not None and isfinite(value) else None

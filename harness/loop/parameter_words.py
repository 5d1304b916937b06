"""What is said of parameters of the loop, beside what is said of those of any system."""

from typing import Any

from fmuloop import parameter_words
from fmuloop.parameter_words import FORMS as FORMS

WORDS = {
    **parameter_words.WORDS,
    "elsewhere": "{name}: {plant} has no parameter {parameter}; {others} has it",
    "without": "{name}: {controllers} has no such parameter and runs without it",
    "torque": "plant.T_0 = {T_0} N.m: the drive train starts with another torque than the {demand} N.m that the driver "
    "demands, and swings from the first instant on",
}


def said(what: str, /, **of: Any) -> str:
    """One of WORDS with what stands there in braces; numbers with six digits."""
    return parameter_words.filled(WORDS[what], **of)

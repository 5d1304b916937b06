"""What is said of parameters that a user sets, once for --set and for what is typed on a page."""

from typing import Any

FORMS = {"constant": "plant.J_1=0.06", "changed": "INSTANCE.PARAMETER@TIME=VALUE, as controller.k_d@2.0=1.5"}
"""How one is written, from the start on and from a time on."""

WORDS = {
    "form": "{text} is not of the form {form}",
    "finite": "{text}: a parameter is a finite number",
    "twice": "{name} is given twice, {before} and {value}; it takes one value",
    "time": "{name}: {time} is no time in s, as 2.0 in controller.k_d@2.0",
    "late": "{name}: the steps of the run begin at 0 to {last} s",
    "same_step": "{name}: {parameter} is set twice at that step",
    "fixed": "{name}: in {file} {parameter} is fixed and cannot change in a run",
    "bounds": "{file} takes {low} to {high} {unit}",
    "instance": "{name}: there is no instance {instance}",
    "lacks": "{name}: {file} has no {causality} {parameter}",
}


def said(what: str, /, **of: Any) -> str:
    """One of WORDS with what stands there in braces."""
    return filled(WORDS[what], **of)


def filled(text: str, /, **of: Any) -> str:
    """A text with what stands there in braces; numbers with six digits."""
    return text.format(**{name: f"{value:g}" if isinstance(value, float) else value for name, value in of.items()})

"""The signal dictionary (SSB): what the FMUs put out, with units and meaning."""

from ...cosimulation.interface import unit_of
from ...cosimulation.wiring import Fit
from .variables import outputs, typed, units
from .xml import VERSION, document, element


def dictionary(fitted: Fit, tool: str) -> bytes:
    """The file of the dictionary, by names `instance.variable`; of Reals alone, as others stop FMPy."""
    signals = {name: variable for name, variable in outputs(fitted).items() if variable.type == "Real"}
    entries = [
        element(
            "ssb:DictionaryEntry",
            {"name": name, "description": variable.description or name},
            [typed("ssc", "Real", unit_of(variable))],
        )
        for name, variable in signals.items()
    ]
    return document(
        element(
            "ssb:SignalDictionary",
            {"version": VERSION, "generationTool": tool},
            [*entries, *units("ssb", fitted, map(unit_of, signals.values()))],
        )
    )

"""What hosts of our FMUs may do, as a table: a test drives each FMU so from C, and the documentation prints it."""

from typing import NamedTuple

PLAIN = ()
"""A host that sets inputs in initialization mode, makes steps of 1 ms and counts them."""


class LegalHost(NamedTuple):
    """A row of the table.

    Attributes:
        does: in words.
        options: of legal_hosts.c.
        like: options of the host whose numbers it must get: to the last bit, but for a continuous block in steps of
            another size.
        folder: that has the library; "" for where it was unpacked.
    """

    does: str
    options: tuple[str, ...]
    like: tuple[str, ...] = PLAIN
    folder: str = ""


STEPS = ("step=0.0007", "step=0.003", "step=0.01")
ODD_FOLDER = "nur lesbar, für Ähnliches"
ESCAPED = "nur%20lesbar,%20f%C3%BCr%20%C3%84hnliches"

HOSTS = (
    LegalHost("sets inputs before initialization mode", ("inputs=before",)),
    LegalHost("sets inputs after initialization alone", ("inputs=after",), ("inputs=start",)),
    *(LegalHost(f"makes steps of {float(step[5:]) * 1e3:g} ms", (step,)) for step in STEPS),
    LegalHost("adds up its time", ("adds_up=1",)),
    LegalHost("starts a week later, and adds up", ("start=604800", "adds_up=1")),
    LegalHost("changes a tunable parameter, in steps of 3 ms", ("tunes=1", "step=0.003"), ("tunes=1",)),
    LegalHost("makes a run, resets and makes it again", ("reset=1",)),
    LegalHost("saves the state as bytes every .21 s, and goes on in another instance", ("restore=1",)),
    LegalHost("saves and goes on elsewhere in steps of .7 ms", ("restore=1", "step=0.0007")),
    LegalHost("runs five instances at a time, in threads", ("threads=1",)),
    LegalHost("gives no folder of resources", ("uri=",)),
    LegalHost("has it in a read-only folder with spaces and umlauts", (f"uri=file:///{ESCAPED}",), PLAIN, ODD_FOLDER),
)

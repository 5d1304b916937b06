"""What hosts of our FMUs may do, as a table: a test drives FMUs so from C, and the documentation prints it."""

from typing import Literal, NamedTuple

PLAIN = ()
"""A host that sets inputs in initialization mode, makes steps of 1 ms and counts them."""


class LegalHost(NamedTuple):
    """A row of the table.

    Attributes:
        does: in words.
        options: of legal_hosts.c; LASTS stands for how long the FMU runs.
        like: options of the host whose numbers it must get: to the last bit, but for a continuous block in steps of
            another size.
        unpacked: where the FMU is; one that runs Python is always in some folder.
    """

    does: str
    options: tuple[str, ...]
    like: tuple[str, ...] = PLAIN
    unpacked: Literal["in a folder", "in an odd folder", "nowhere"] = "in a folder"


STEPS = ("step=0.0007", "step=0.003", "step=0.01")
LASTS = "lasts"
LONG, LONG_IN_PYTHON = 3600, 10
"""How long, in s: native FMUs, of which two for FMI 2.0 run as long as LONGER says, and those that run Python. Those
for FMI 3.0 count steps by the same C."""

LONGER = {"DampingController": 86_400, "MotorTorqueLoop": 86_400}
"""A week was 58 s of a processor in each run of all tests; a host that begins a week later has its times."""

HOSTS = (
    LegalHost("sets inputs before initialization mode", ("inputs=before",)),
    LegalHost("sets inputs after initialization alone", ("inputs=after",), ("inputs=start",)),
    LegalHost("exchanges nothing before its first step", ("inputs=none",), ("inputs=late",)),
    *(LegalHost(f"makes steps of {float(step[5:]) * 1e3:g} ms", (step,)) for step in STEPS),
    LegalHost("adds up its time", ("adds_up=1",)),
    LegalHost("begins a week later, and adds up", ("begins=604800", "adds_up=1")),
    LegalHost(
        "runs for a day in steps of 10 ms, and adds up its time (bus and plants: an hour; with Python: 10 s)",
        (LASTS, "of=0.01", "adds_up=1"),
        (LASTS, "of=1"),
    ),
    LegalHost(
        "changes a tunable parameter before and in initialization mode and every .21 s, in steps of 3 ms",
        ("tunes=1", "step=0.003"),
        ("tunes=1",),
    ),
    LegalHost("makes a run, resets and makes it again", ("reset=1",)),
    LegalHost("saves the state as bytes every .21 s, and goes on in another instance", ("restore=1",)),
    LegalHost("saves and goes on elsewhere in steps of .7 ms", ("restore=1", "step=0.0007")),
    LegalHost("runs five instances at a time, in threads", ("threads=1",)),
    LegalHost("has it in a read-only folder with spaces and umlauts", (), PLAIN, "in an odd folder"),
    LegalHost("gives no folder of resources (native FMUs)", (), PLAIN, "nowhere"),
)

"""What an FMU allows its host and how it refuses the rest: the same in both builds.

Python takes the names in capitals from here, C from a header that is made of them (native/shared_header.py).
A sentence is a format with named fields; `!r` is a number as Python writes it, `:d` a whole one from 0 on. What
only one build can refuse is said where it is refused.
"""

from enum import IntFlag

ANY_NUMBER, FROM_START_ON, THE_START_TIME, WITHIN_A_SAMPLE = (
    "any finite number",
    "the start time and later",
    "the start time, before the end of initialization mode",
    "from -1 to 1",
)

TIME_TOLERANCE = 1e-6
"""In s: how far the host's time may be from the FMU's."""

LONGEST_COMMUNICATION_STEP = 1000.0
"""In s: a longer communication step is a mistake of the host, and would keep it waiting for ever."""


INPUT_TOLERANCE = 1e-6
"""Of the range of an input: so far outside its end is meant."""


class Mode(IntFlag):
    """Where an instance is in the sequence of calls; in the last two only where the host integrates (native build)."""

    INSTANTIATED = 1
    INITIALIZATION = 2
    STEPPING = 4
    TERMINATED = 8
    EVENT = 16
    CONTINUOUS_TIME = 32


MODE_NAMES = (
    *("before initialization mode", "in initialization mode", "after initialization", "after termination"),
    *("in event mode", "in continuous-time mode"),
)
"""In the order of the modes."""

LOG_ERROR, LOG_DISCARD = "logStatusError", "logStatusDiscard"

LOG_CATEGORIES = {
    LOG_ERROR: "a call that was refused, and why; nothing has changed",
    LOG_DISCARD: "a step or a parameter that was refused, and that the host can do without; nothing has changed",
}

WRONG_MODE = "{function} is refused {mode}; its place is {place}"

BAD_START_TIME = "startTime = {time!r} s is refused; allowed is any finite number"
BAD_STOP_TIME = "stopTime = {time!r} s is refused; allowed is the startTime = {start!r} s and later"
BAD_STEP_SIZE = "communicationStepSize = {size!r} s is refused; allowed is above 0 to {longest:g} s"
BAD_TIME = "currentCommunicationPoint = {time!r} s is refused; {model} has been computed up to {reached!r} s"
STEP_LOST = "communicationStepSize = {size!r} s is refused; added to the time {time!r} s it leaves it as it is"
PAST_STOP_TIME = "a step to {end!r} s is refused; the run was said to stop at {stop!r} s"

UNKNOWN_REFERENCE = "value reference {reference:d} is unknown; {model} has 0 to {last:d}"
WRONG_TYPE = "{name} is of type {type}, not {asked}"
OUTPUT_SET = "{name} is an output and cannot be set"
SET_TOO_LATE = (
    "{name} = {value!r} is refused; a fixed parameter can be set until initialization mode is left, a tunable one "
    "between steps (in model exchange: in event mode), an input until termination, and all again after a reset"
)
BAD_VALUE = "{name} = {value!r}{unit} is refused; allowed is {allowed}"

NOT_INTEGRABLE = (
    "the step of {size!r} s is refused; {state} changes too fast to be followed with these parameters and inputs"
)
TOO_MUCH_WORK = (
    "the step of {size!r} s is refused; {state} changes so fast that it would take too long; shorter steps are allowed"
)
NOT_FINITE = "the step of {size!r} s is refused; {name} would be {value!r}"

DAMAGED_STATE = "the FMU state is refused: its bytes are damaged"
BAD_STATE = "the FMU state is refused: {name} = {value!r} in it; allowed is {allowed}"
FOREIGN_STATE = "the FMU state is refused: it was saved by {origin}, this is {build}"

"""The C files call in one direction: each knows only those before it, so that none can be part of a circle."""

import re
from pathlib import Path

from driveline.fmus.native.packaging import C_FILES
from tests.together import together

TARGET_FILES = C_FILES.parents[1] / "target" / "c"

ORDERS = {
    C_FILES: (
        "messages.c",
        "first_instance.c",
        "values.c",
        "explicit.c",
        "implicit.c",
        "integrator.c",
        "continuous.c",
        "sampled.c",
        "terminal.c",
        "content.c",
        "state.c",
        "run.c",
        "frames.c",
        "calls.c",
        "fmi2.c",
        "model_exchange.c",
        "fmi2_model_exchange.c",
        "fmi3.c",
        "fmi3_instance.c",
        "fmi3_refused.c",
        "fmi3_model_exchange.c",
        "fmi3_terminal.c",
        "lanes.c",
        "lane_loop.c",
    ),
    TARGET_FILES: ("board_host.c", "board_mps2.c", "link.c", "scheduler.c"),
}

DEFINED = re.compile(r"^(?:__attribute__\(\(weak\)\) )?[a-zA-Z].*?(\w+)\([^;{#]*\)\n\{", re.MULTILINE)
CALLED = re.compile(r"\b(\w+)\(")
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
ENTRY = "main"
"""What every start calls, wherever it stands."""


def defined(file: Path) -> set[str]:
    """The names of the functions that a file defines."""
    return set(DEFINED.findall(COMMENT.sub("", file.read_text(encoding="utf-8"))))


def called(file: Path) -> set[str]:
    """The names that a file calls, or defines."""
    return set(CALLED.findall(COMMENT.sub("", file.read_text(encoding="utf-8"))))


@together("folder", ORDERS)
def test_a_file_calls_no_function_of_a_later_one(folder: Path) -> None:
    order = ORDERS[folder]
    assert {file.name for file in folder.glob("*.c")} == set(order)
    for n, name in enumerate(order):
        known = called(folder / name) - {ENTRY}
        for later in order[n + 1 :]:
            assert known & defined(folder / later) <= defined(folder / name), (name, later)


def test_the_functions_of_a_file_are_found() -> None:
    assert {"integrate", "advance_through", "first_crossing"} <= defined(C_FILES / "integrator.c")
    assert "integrate_stiff" in called(C_FILES / "integrator.c") - defined(C_FILES / "integrator.c")

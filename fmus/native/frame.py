"""frame.h: the frame that an FMU with a terminal sends, and the names of the members of that."""

from ...models.block.frame import layout
from ..description.terminal import BAUD_RATE, OPERATIONS_SIZE, members
from ..fmu import Fmu

HEADER = """/* {frame}: the frame that is sent, and the terminal; written by build_fmus.py from {module}. */
#ifndef FRAME_H
#define FRAME_H

#define FRAME_COUNTER {counter} /* among the outputs: one more with every frame */

enum {{ FRAME_IDENTIFIER = {identifier:#x}, FRAME_SIGNALS = {signals}, FRAME_LENGTH = {length} /* bytes */ }};
enum {{ BAUD_RATE = {baud_rate} /* bit/s */, OPERATIONS_SIZE = {size} /* bytes, at most */ }};
enum {{ TX_DATA = {first}, TX_CLOCK, RX_DATA, RX_CLOCK }}; /* value references */

static const unsigned frame_bits[FRAME_SIGNALS] = {{{bits}}};
static const char *const terminal_names[] = {{{names}}}; /* from TX_DATA on */

#endif
"""


def frame_header(fmu: Fmu) -> str:
    """The header, for the first frame of the block with its start values."""
    frame, terminal = fmu.block.frames[0], members(fmu.block)
    bits = [layout(content, fmu.block.Parameters()).bits for content in frame.contents]
    return HEADER.format(
        frame=frame.name,
        module=fmu.module,
        counter=frame.counter,
        identifier=frame.identifier,
        signals=len(bits),
        length=(sum(bits) + 7) // 8,
        baud_rate=BAUD_RATE,
        size=OPERATIONS_SIZE,
        first=min(terminal.values()),
        bits=", ".join(map(str, bits)),
        names=", ".join(f'"{name}"' for name in terminal),
    )

"""A saved state of the Python build with a right checksum and a form that no instance can have written is refused."""

import json
import math

import pytest
from fmutesting.forged import with_checksum
from fmutesting.host import opened
from fmutesting.together import together

from fmublocks.python import content


def changed(path, value):
    """Changes the content of a state at a path in it."""

    def change(saved):
        build, content = json.loads(saved[8:])
        where = content
        for step in path[:-1]:
            where = where[step]
        where[path[-1]] = value
        return with_checksum(json.dumps([build, content]).encode())

    return change


MODE, TIME, INPUTS, PARAMETERS, MEMORY = 0, 3, 4, 5, 6

FORMS = [
    changed([MODE], "stepping"),
    changed([MODE], [4]),
    changed([MODE], 6),
    changed([MODE], 1),
    changed([TIME], None),
    changed([TIME], 10**400),
    changed([INPUTS], []),
    changed([INPUTS, 0], "1.0"),
    changed([PARAMETERS, 0], [0.0]),
    changed([MEMORY], None),
    changed([MEMORY], []),
    changed([MEMORY, 0], 7),
    changed([MEMORY, 2], 1),
    changed([MEMORY, 2], True),
    lambda saved: with_checksum(saved[8:-1]),
    lambda saved: with_checksum(b"[" * 100_000),
    lambda saved: with_checksum(b"\xff"),
    lambda saved: with_checksum(b"{}"),
]


@pytest.fixture(scope="module")
def host(built, tmp_path_factory):
    with opened(built / "WheelSpeedCan.fmu", tmp_path_factory.mktemp("can")) as host:
        host.initialize()
        host.step(0.0, 0.001)
        yield host


@together("change", FORMS)
def test_a_form_that_no_instance_can_have_written_is_refused(host, change):
    saved = bytes(host.fmu.serializeFMUstate(host.fmu.getFMUstate()))
    message = host.refuses(host.fmu.deSerializeFMUstate, change(saved))
    assert message == "the FMU state is refused: its bytes are damaged"
    host.fmu.setFMUstate(host.fmu.deSerializeFMUstate(saved))


@together("value", [0.1, -0.0, 5e-324, 1.7976931348623157e308, math.inf, math.nan, 3, True])
def test_numbers_keep_type_and_bits(value):
    (restored,) = content.unpack("build", content.pack("build", (value,)))
    assert (type(restored), repr(restored)) == (type(value), repr(value))

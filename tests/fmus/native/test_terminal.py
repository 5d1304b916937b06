"""The terminal of the FMU that sends its frames over a bus: event mode, clocks, binary variables, saved states."""

import struct
import zipfile
from pathlib import Path
from typing import Any

import fmpy
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from fmutesting.bus import CAN_TRANSMIT, CONFIGURATION, CONFIRM, FORMAT_ERROR, Node, Operation, frame_in, written
from fmutesting.forged import sealed
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]

from driveline.fmus.catalogue import FMUS
from driveline.models.wheel_speed_can import FRAME
from fmublocks.builds import NotPossible, sender_builder
from fmublocks.description.terminal import FOLDER, OPERATIONS_SIZE

DATABASE = b'VERSION ""\n'
SPEEDS = (40.0, 41.0)
"""Of the wheels in rad/s."""


@pytest.fixture(scope="module")
def sender(tmp_path_factory) -> Path:
    try:
        build = sender_builder(DATABASE)
    except NotPossible as reason:
        pytest.skip(str(reason))
    return build(FMUS["WheelSpeedCan"], tmp_path_factory.mktemp("sender"))


@pytest.fixture
def node(sender, tmp_path) -> Node:
    return Node(sender, tmp_path)


@pytest.fixture
def receiving(node) -> Node:
    """In event mode, with nothing left to send."""
    node.start()
    node.flush()
    node.fmu.enterEventMode()
    return node


def started(node: Node, **values: Any) -> Node:
    """In step mode."""
    node.start(**values)
    node.flush()
    return node


def frames(node: Node, steps: int, size: float) -> list[bytes]:
    """The data of the frames of a run with constant speeds."""
    found = []
    for _ in range(steps):
        if node.step(size, *SPEEDS):
            found += [frame_in(operation)[1] for operation in node.events()]
    return found


def refused(node: Node, call: Any, *arguments: Any) -> str:
    with pytest.raises(FMICallException):
        call(*arguments)
    return node.told[-1]


def test_the_description_and_that_of_the_terminal_are_valid(sender, tmp_path):
    (odd,) = validate_fmu(str(sender))  # the standard wants no clock there
    assert "Expected {Powertrain.Tx_Clock, counter, omega_2_can, valid} but was {counter, omega_2_can, valid}" in odd
    fmpy.extract(str(sender), str(tmp_path))
    description: Any = fmpy.read_model_description(str(sender))
    assert description.coSimulation.hasEventMode
    schema = etree.XMLSchema(etree.parse(Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd"))
    terminals = etree.parse(tmp_path / "terminalsAndIcons" / "terminalsAndIcons.xml")
    schema.assertValid(terminals)
    (terminal,) = terminals.iterfind("Terminals/Terminal")
    variables = {v.name: v for v in description.modelVariables}
    members = {m.get("memberName"): variables[m.get("variableName")] for m in terminal.iterfind("*")}
    assert {name: (v.type, v.causality) for name, v in members.items()} == {
        "Tx_Data": ("Binary", "output"),
        "Tx_Clock": ("Clock", "output"),
        "Rx_Data": ("Binary", "input"),
        "Rx_Clock": ("Clock", "input"),
    }
    for side in ("Tx", "Rx"):
        assert [v.name for v in members[f"{side}_Data"].clocks] == [members[f"{side}_Clock"].name]
        assert members[f"{side}_Clock"].intervalVariability == "triggered"


def test_value_references_are_those_of_fmi_3_and_behind_them_come_those_of_the_terminal(fmi3, sender):
    known: Any = fmpy.read_model_description(str(fmi3 / "WheelSpeedCan.fmu")).modelVariables
    found: Any = fmpy.read_model_description(str(sender)).modelVariables
    assert [(v.name, v.valueReference) for v in found[: len(known)]] == [(v.name, v.valueReference) for v in known]
    assert [v.valueReference for v in found] == list(range(len(known) + 4))


def test_manifest_and_database_are_where_the_standard_wants_them(sender):
    with zipfile.ZipFile(sender) as archive:
        manifest = etree.fromstring(archive.read(f"{FOLDER}/fmi-ls-manifest.xml"))
        assert archive.read(f"{FOLDER}/Powertrain.dbc") == DATABASE
    assert manifest.get("{http://fmi-standard.org/fmi-ls-manifest}fmi-ls-name") == "org.fmi-standard.fmi-ls-bus"
    assert manifest.get("isBusSimulationFMU") == "false"


def test_the_baud_rate_and_that_frames_may_wait_are_told_first(node):
    node.start()
    assert node.flush() == [
        Operation(CONFIGURATION, b"\x01" + struct.pack("<I", 500_000)),
        Operation(CONFIGURATION, b"\x04\x01"),
    ]


def test_a_frame_is_sent_for_each_message_that_arrives(node):
    started(node, d_max=0.001)
    found = frames(node, 1000, 1e-3)
    assert len(found) == node.fmu.getInt32([node.references["counter"]])[0] > 45
    speed = struct.unpack("<H", found[-1][:2])[0] * 0.03125
    assert speed == pytest.approx(3.6 * 0.5 * sum(SPEEDS) * 0.29, rel=0.02)
    assert [data[2] & 1 for data in found[-5:]] == [1] * 5


def test_counter_and_validity_stand_behind_the_speed_and_the_counter_begins_again(node):
    found = frames(started(node, T_cyc=0.01, d_max=0.001), 2700, 1e-3)
    counters = [(data[2] >> 1) | (data[3] & 1) << 7 for data in found]
    assert len(counters) > 260
    assert counters == [k % 256 for k in range(1, len(counters) + 1)]


def test_a_long_step_sends_what_has_arrived_in_it_and_ends_as_short_ones_do(node, sender, tmp_path):
    other = started(Node(sender, tmp_path))
    started(node)
    assert frames(node, 500, 1e-3) == frames(other, 5, 0.1)
    assert other.time == pytest.approx(node.time, abs=1e-9)
    assert frames(node, 250, 1e-3) == frames(other, 100, 2.5e-3)


def test_a_step_with_more_frames_than_there_is_room_for_is_discarded_and_shorter_ones_do(node):
    """102 operations of 20 bytes are 2040 of the 2048."""
    started(node, T_cyc=0.01, d_max=0.001)
    assert OPERATIONS_SIZE == 2048
    message = refused(node, node.step, 1.1, *SPEEDS)
    assert message == (
        "the step of 1.1 s is refused; Tx_Data has no room for the frames that arrive in it; shorter steps are allowed"
    )
    assert node.fmu.getFloat64([node.references["time"]]) == [0.0]
    assert node.step(1.0, *SPEEDS)
    assert len(node.events()) in (99, 100)


def test_the_clock_is_active_in_event_mode_alone_and_until_that_is_updated(node):
    started(node)
    while not node.step(1e-3, *SPEEDS):
        assert node.sent() == b""
    assert node.sent() == b""
    node.fmu.enterEventMode()
    assert len(node.sent()) == len(node.sent()) == 20, "until the update"
    assert not node.update()
    assert node.sent() == b""
    node.fmu.enterStepMode()
    assert not node.step(1e-3, *SPEEDS)


def test_what_no_host_fetches_is_still_there_after_the_next_step(node):
    started(node)
    found = 0
    for _ in range(200):
        found = max(found, node.step(1e-3, *SPEEDS))
    assert found
    assert len(node.events()) > 5


def test_without_event_mode_it_is_the_fmu_without_terminal(fmi3, sender, tmp_path):
    ours = Node(sender, tmp_path / "with", events=False)
    other = Node(fmi3 / "WheelSpeedCan.fmu", tmp_path / "without", events=False)
    for node in (ours, other):
        node.start()
    for _ in range(500):
        assert not ours.step(1e-3, *SPEEDS)
        other.step(1e-3, *SPEEDS)
        assert ours.fmu.getFloat64([2]) == other.fmu.getFloat64([2])
    message = "fmi3EnterEventMode is refused; the instance was made without event mode"
    assert refused(ours, ours.fmu.enterEventMode) == message


def test_what_is_not_for_it_is_passed_over(receiving):
    known = {FORMAT_ERROR: 2, CAN_TRANSMIT: 8, CONFIRM: 4}
    known |= {0x11: 9, 0x12: 14, 0x30: 4, 0x31: 7, 0x40: 1, 0x41: 1, 0x42: 0}
    receiving.receive(b"".join(written(Operation(code, bytes(least))) for code, least in known.items()))
    assert receiving.fmu.getClock([receiving.members["Rx_Clock"]]) == [True]
    assert not receiving.update()
    assert receiving.fmu.getClock([receiving.members["Rx_Clock"]]) == [False]


@pytest.mark.parametrize(
    "data",
    [
        written(Operation(0x13, b"")),
        written(Operation(CAN_TRANSMIT, bytes(7))),
        written(Operation(CONFIRM, bytes(3))),
        struct.pack("<II", CONFIRM, 13) + bytes(4),
        struct.pack("<II", CONFIRM, 7),
        struct.pack("<I", CONFIRM),
    ],
)
def test_what_is_no_operation_is_sent_back_and_what_is_before_it_counts(receiving, data):
    receiving.receive(written(Operation(CONFIRM, bytes(4))) + data)
    assert receiving.flush() == [Operation(FORMAT_ERROR, struct.pack("<H", len(data)) + data)]


def test_of_any_bytes_what_is_no_operation_comes_back(node):
    started(node)
    pieces = st.one_of(
        st.binary(max_size=40),
        st.builds(lambda code, data: written(Operation(code, data)), st.integers(0, 0x50), st.binary(max_size=20)),
    )

    @given(st.lists(pieces, max_size=12).map(b"".join))
    def answered(data):
        node.fmu.enterEventMode()
        node.receive(data)
        found = node.flush()
        assert {operation.code for operation in found} <= {FORMAT_ERROR}
        at = 0
        for operation in found:
            (size,) = struct.unpack_from("<H", operation.arguments)
            assert len(operation.arguments) == 2 + size
            at = data.index(operation.arguments[2:], at) + size

    answered()


def test_what_comes_without_its_clock_is_not_looked_at(receiving):
    receiving.fmu.setBinary([receiving.members["Rx_Data"]], [b"nonsense"])
    assert receiving.fmu.getBinary([receiving.members["Rx_Data"]]) == [b"nonsense"]
    assert receiving.flush() == []


def test_as_much_as_there_is_room_for_can_come_in(node):
    node.start()
    rx = [node.members["Rx_Data"]]
    node.fmu.setBinary(rx, [bytes(OPERATIONS_SIZE)])
    assert refused(node, node.fmu.setBinary, rx, [bytes(OPERATIONS_SIZE + 1)]) == (
        "Powertrain.Rx_Data with 2049 bytes is refused; allowed are 0 to 2048"
    )
    assert node.fmu.getBinary(rx) == [bytes(OPERATIONS_SIZE)]
    node.receive(bytes(OPERATIONS_SIZE))
    assert node.flush()[2:] == [], "there is no room for the answer"


def test_wrong_variables_are_refused_by_name(node):
    node.start()
    tx, clock, rx, rx_clock = (node.members[name] for name in ("Tx_Data", "Tx_Clock", "Rx_Data", "Rx_Clock"))
    for message, call, *arguments in (
        ("Powertrain.Tx_Data is an output and cannot be set", node.fmu.setBinary, [tx], [b""]),
        ("Powertrain.Tx_Clock is an output and cannot be set", node.fmu.setClock, [rx_clock, clock], [True, True]),
        ("Powertrain.Tx_Clock is of type Clock, not Binary", node.fmu.getBinary, [clock]),
        ("Powertrain.Rx_Clock is of type Clock, not Binary", node.fmu.setBinary, [rx_clock], [b""]),
        ("Powertrain.Rx_Data is of type Binary, not Clock", node.fmu.getClock, [rx]),
        ("Powertrain.Rx_Data is of type Binary, not Clock", node.fmu.setClock, [rx], [True]),
        ("omega_2_can is of type Float64, not Clock", node.fmu.getClock, [2]),
        ("omega_2_can is of type Float64, not Binary", node.fmu.getBinary, [2]),
    ):
        assert refused(node, call, *arguments) == message
    assert "is unknown" in refused(node, node.fmu.getBinary, [rx_clock + 1])
    assert node.fmu.getClock([rx_clock]) == [False]


def test_functions_of_event_mode_are_refused_elsewhere(node):
    rx, clock = [node.members["Rx_Data"]], [node.members["Rx_Clock"]]
    assert "is refused before initialization mode" in refused(node, node.update)
    node.start()
    assert "fmi3DoStep is refused in event mode" in refused(node, node.step, 1e-3)
    node.flush()
    for call, *arguments in (
        (node.update,),
        (node.fmu.enterStepMode,),
        (node.fmu.setClock, clock, [True]),
        (node.fmu.setBinary, rx, [b""]),
    ):
        assert "is refused after initialization" in refused(node, call, *arguments)
    node.fmu.enterEventMode()
    node.fmu.terminate()
    assert "is refused after termination" in refused(node, node.fmu.enterEventMode)


def test_what_is_to_be_sent_is_part_of_a_saved_state_and_forgotten_by_a_reset(node, sender, tmp_path):
    started(node)
    while not node.step(1e-3, *SPEEDS):
        pass
    node.fmu.enterEventMode()
    sent = node.sent()
    state = node.fmu.getFMUState()
    saved = node.fmu.serializeFMUState(state)
    node.update()
    node.fmu.setFMUState(state)
    assert node.sent() == sent
    node.fmu.reset()
    assert len(started(node).events()) == 0
    other = started(Node(sender, tmp_path))
    other.fmu.setFMUState(other.fmu.deserializeFMUState(saved))
    assert other.sent() == sent != b""
    assert [frame_in(operation)[0] for operation in other.flush()] == [FRAME.identifier]


def test_a_damaged_or_foreign_state_is_refused(node, sender, tmp_path):
    started(node)
    node.fmu.enterEventMode()
    saved = bytes(node.fmu.serializeFMUState(node.fmu.getFMUState()))
    sizes = len(saved) - 2 * OPERATIONS_SIZE - 16
    for offset in (sizes, sizes + 8):
        for size, good in ((OPERATIONS_SIZE, True), (OPERATIONS_SIZE + 1, False), (2**64 - 1, False)):
            bad = sealed(saved[4:offset] + struct.pack("=Q", size) + saved[offset + 8 :])
            if good:
                node.fmu.deserializeFMUState(bad)
            else:
                assert refused(node, node.fmu.deserializeFMUState, bad).endswith("its bytes are damaged")
    other = Node(sender, tmp_path, events=False)
    assert "is refused" in refused(other, other.fmu.deserializeFMUState, saved)

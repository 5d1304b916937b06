"""The FMU that sends its frames talks with the examples of the standard, built from their sources.

They are not part of the project: the variable FMI_LS_BUS names a folder with clones of modelica/fmi-ls-bus (v1.0.0) and
modelica/fmi-ls-bus-examples.
"""

import ctypes
import os
import re
import subprocess
from json import dumps
from pathlib import Path
from shutil import copyfile, make_archive
from typing import Any

import fmpy
import numpy as np
import pytest
from fmutesting.bus import CONFIRM, Node, frame_in, operations
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]

from driveline.models.wheel_speed_can import FRAME
from fmublocks.description.terminal import FOLDER
from fmublocks.native.compiler import host_compiler
from fmublocks.native.packaging import FMI_HEADERS

STANDARD = Path(os.environ.get("FMI_LS_BUS", "."))
HEADERS, EXAMPLES = STANDARD / "fmi-ls-bus" / "headers", STANDARD / "fmi-ls-bus-examples"

pytestmark = pytest.mark.skipif(
    not (HEADERS.is_dir() and EXAMPLES.is_dir()),
    reason="FMI_LS_BUS names no folder with clones of fmi-ls-bus and fmi-ls-bus-examples",
)

STEP = 1e-3
BITS = 48
"""Of a frame of four bytes, as the example of a bus counts them: 44 and one for each byte."""


def example(name: str, folder: Path) -> Path:
    """The folder of an example, with its binary for this machine."""
    described = EXAMPLES / name / "description" / "modelDescription.xml"
    made = folder / name
    made.mkdir()
    copyfile(described, made / described.name)
    described_as: Any = fmpy.read_model_description(str(made), validate=False)
    identifier = described_as.coSimulation.modelIdentifier
    binary = made / "binaries" / str(fmpy.platform_tuple) / f"{identifier}{fmpy.sharedLibraryExtension}"
    binary.parent.mkdir(parents=True)
    flags = ("-shared", "-fPIC", "-D_strdup=strdup", "-D_GNU_SOURCE", "-DFMI3_OVERRIDE_FUNCTION_PREFIX")
    sources = (EXAMPLES / name / "src").glob("*.c")
    subprocess.run(
        [host_compiler(), *flags, f"-I{HEADERS}", f"-I{FMI_HEADERS}", *sources, "-o", binary],
        check=True,
        capture_output=True,
    )
    return made


def wheel_speeds(results: Any, steps: int) -> np.ndarray:
    return np.column_stack([results["plant.omega_wheel_L"], results["plant.omega_wheel_R"]])[-steps:]


def test_it_talks_directly_with_the_example_of_a_node(sender: Path, results: Any, tmp_path: Path) -> None:
    ours = Node(sender, tmp_path / "sender")
    other = Node(Path(), example("can-node-triggered-output", tmp_path), "CanChannel")
    sent, received, answers = [], 0, []
    for node in (ours, other):
        node.start()
    for inputs in wheel_speeds(results, 1000):
        to_other, to_us = ours.sent(), other.sent()
        for node, data in ((ours, to_us), (other, to_other)):
            if data:
                node.receive(data)
        sent += [frame_in(operation) for operation in operations(to_other) if operation.code == 0x10]
        received += sum(operation.code == 0x10 for operation in operations(to_us))
        answers += ours.flush()[len(operations(to_other)) :]
        other.flush()
        ours.step(STEP, *inputs)
        other.step(STEP)
        for node in (ours, other):
            node.fmu.enterEventMode()
    heard = [text for text in other.told if text.startswith("Received CAN frame")]
    assert len(sent) >= 45
    assert heard == [f"Received CAN frame with ID {FRAME.identifier} and length 4"] * len(sent)
    assert not any("unknown" in text for text in other.told)
    assert received == 3
    assert answers == []


def test_it_talks_over_the_example_of_a_bus(sender: Path, results: Any, tmp_path: Path) -> None:
    first, second = Node(sender, tmp_path / "sender"), Node(sender, tmp_path / "sender")
    bus = Node(Path(), example("can-bus-simulation", tmp_path), "Node1")
    clocks = [bus.references[f"Node{k}.Tx_Clock"] for k in (1, 2)]
    nodes = (first, second)
    for node in (first, second, bus):
        node.start(**{"seed": 2} if node is second else {})
    sent, heard, confirmed, due = ([], []), ([], []), [0, 0], None

    def exchange() -> float | None:
        """Everything in event mode, back to step mode; when the bus asks for it again."""
        active = due is not None and abs(bus.time - due) < 1e-9
        if active:
            bus.fmu.setClock(clocks, [True, True])
        for k, node in enumerate(nodes):
            if data := node.sent():
                bus.fmu.setClock([bus.references[f"Node{k + 1}.Rx_Clock"]], [True])
                bus.fmu.setBinary([bus.references[f"Node{k + 1}.Rx_Data"]], [data])
                sent[k].extend((node.time, frame_in(found)) for found in operations(data) if found.code == 0x10)
        if active:
            for k, node in enumerate(nodes):
                (data,) = bus.fmu.getBinary([bus.references[f"Node{k + 1}.Tx_Data"]])
                node.receive(data)
                for found in operations(data):
                    if found.code == CONFIRM:
                        confirmed[k] += 1
                    else:
                        heard[k].append((node.time, frame_in(found)))
        for node in (*nodes, bus):
            assert not node.update(), "nothing is sent back"
        intervals, qualifiers = (ctypes.c_double * 2)(), (ctypes.c_int * 2)()
        bus.fmu.getIntervalDecimal(
            (ctypes.c_uint * 2)(*clocks), intervals, ctypes.cast(qualifiers, ctypes.POINTER(ctypes.c_int))
        )
        for node in (*nodes, bus):
            node.fmu.enterStepMode()
        return bus.time + intervals[0] if qualifiers[0] == 2 else (None if active else due)

    due = exchange()
    for k, inputs in enumerate(wheel_speeds(results, 1000), 1):
        while bus.time < k * STEP - 1e-9:
            size = min(k * STEP, due or 1e9) - bus.time
            for node in nodes:
                node.step(size, *inputs)
            bus.step(size)
            for node in (*nodes, bus):
                node.fmu.enterEventMode()
            due = exchange()
    assert len(sent[0]) >= 45
    for k in (0, 1):
        done = len(heard[1 - k])
        assert 0 <= len(sent[k]) - done <= 1
        assert [frame for _, frame in heard[1 - k]] == [frame for _, frame in sent[k][:done]]
        delays = [later - earlier for (later, _), (earlier, _) in zip(heard[1 - k], sent[k], strict=False)]
        assert min(delays) == pytest.approx(BITS / 500_000, abs=1e-9)
        assert max(delays) <= 2.0 * BITS / 500_000 + 1e-9, "when both send at once"
        assert confirmed[k] == done


def test_the_manifest_is_valid(sender: Path, tmp_path: Path) -> None:
    fmpy.extract(str(sender), str(tmp_path))
    schema = (STANDARD / "fmi-ls-bus" / "schema" / "fmi3LayeredStandardBusManifest.xsd").read_text()
    of_fmi = Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3LayeredStandardManifest.xsd"
    local = re.sub(r'schemaLocation="https://[^"]*"', f'schemaLocation="{of_fmi.as_uri()}"', schema)
    manifest = etree.parse(tmp_path / FOLDER / "fmi-ls-manifest.xml")
    etree.XMLSchema(etree.fromstring(local.encode())).assertValid(manifest)


def test_frames_reach_a_node_in_a_container(sender: Path, tmp_path: Path) -> None:
    """Of fmu-manipulation-toolbox, whose containers hand data to those FMUs alone that stand before the sender."""
    assembly = pytest.importorskip("fmu_manipulation_toolbox.assembly")
    make_archive(str(tmp_path / "node"), "zip", example("can-node-triggered-output", tmp_path))
    (tmp_path / "node.zip").rename(tmp_path / "node.fmu")
    copyfile(sender, tmp_path / "sender.fmu")
    links = [["sender.fmu", f"Powertrain.Tx_{k}", "node.fmu", f"CanChannel.Rx_{k}"] for k in ("Data", "Clock")]
    described = {"name": "bus.fmu", "fmu": ["node.fmu", "sender.fmu"], "link": links}
    (tmp_path / "bus.json").write_text(dumps(described), encoding="utf-8")
    assembly.Assembly("bus.json", default_step_size=STEP, fmu_directory=tmp_path).make_fmu(fmi_version=3)
    told: list[str] = []
    given = {"omega_wheel_L": 30.0, "omega_wheel_R": 30.0}
    settings: Any = {"debug_logging": True, "logger": lambda *message: told.append(str(message[-1]))}
    fmpy.simulate_fmu(
        str(tmp_path / "bus.fmu"), stop_time=1.0, output_interval=STEP, start_values=given, validate=False, **settings
    )
    assert sum(f"Received CAN frame with ID {FRAME.identifier} and length 4" in text for text in told) >= 45

"""A small host for FMUs with a terminal (FMI-LS-BUS): it steps them, enters event mode and carries what they send."""

import struct
from pathlib import Path
from typing import Any, NamedTuple

import fmpy
from fmpy.fmi3 import FMU3Slave

FORMAT_ERROR, CAN_TRANSMIT, CONFIRM, CONFIGURATION = 0x01, 0x10, 0x20, 0x40

HEAD = struct.Struct("<II")
"""Code and length of an operation, which contains the head; numbers have the least byte first (FMI-LS-BUS, 4.1)."""


class Operation(NamedTuple):
    code: int
    arguments: bytes


def operations(data: bytes) -> list[Operation]:
    """Those that stand one behind the other in what a terminal sends."""
    received = []
    while data:
        code, length = HEAD.unpack_from(data)
        assert HEAD.size <= length <= len(data)
        received.append(Operation(code, data[HEAD.size : length]))
        data = data[length:]
    return received


def written(operation: Operation) -> bytes:
    return HEAD.pack(operation.code, HEAD.size + len(operation.arguments)) + operation.arguments


def frame_in(operation: Operation) -> tuple[int, bytes]:
    """Identifier and data of a CAN Transmit with a standard identifier, which is no remote frame."""
    identifier, extended, remote, length = struct.unpack_from("<IBBH", operation.arguments)
    assert (operation.code, extended, remote, length) == (CAN_TRANSMIT, 0, 0, len(operation.arguments) - 8)
    return identifier, operation.arguments[8:]


class Node:
    """An instance with event mode, in the event mode that follows initialization.

    Attributes:
        told: its messages.
    """

    def __init__(self, path: Path, folder: Path, terminal: str = "Powertrain", events: bool = True) -> None:
        if not (folder / "modelDescription.xml").is_file():
            fmpy.extract(str(path), str(folder))
        self.description: Any = fmpy.read_model_description(str(folder), validate=False)
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        members = ("Tx_Data", "Tx_Clock", "Rx_Data", "Rx_Clock")
        self.members = {
            name: self.references[f"{terminal}.{name}"] for name in members if f"{terminal}.{name}" in self.references
        }
        self.told: list[str] = []
        self.time = 0.0
        self.fmu: Any = FMU3Slave(
            guid=self.description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="node",
        )
        self.fmu.instantiate(
            loggingOn=True, eventModeUsed=events, logMessage=lambda *message: self.told.append(message[3].decode())
        )

    def start(self, **values: Any) -> None:
        self.fmu.enterInitializationMode()
        for name, value in values.items():
            kind = "Int32" if isinstance(value, int) else "Float64"
            getattr(self.fmu, f"set{kind}")([self.references[name]], [value])
        self.fmu.exitInitializationMode()

    def step(self, size: float, *inputs: float) -> bool:
        """Whether there is something to be sent after it; `inputs` are those with the first value references."""
        if inputs:
            self.fmu.setFloat64(list(range(len(inputs))), list(inputs))
        needed, *ended, reached = self.fmu.doStep(self.time, size)
        assert ended == [False, False]
        self.time = reached
        return needed

    def sent(self) -> bytes:
        """In event mode, what is sent; none if its clock is not active."""
        if not self.fmu.getClock([self.members["Tx_Clock"]])[0]:
            return b""
        return self.fmu.getBinary([self.members["Tx_Data"]])[0]

    def receive(self, data: bytes) -> None:
        """In event mode."""
        self.fmu.setClock([self.members["Rx_Clock"]], [True])
        self.fmu.setBinary([self.members["Rx_Data"]], [data])

    def update(self) -> bool:
        """Whether event mode goes on."""
        return self.fmu.updateDiscreteStates()[0]

    def flush(self) -> list[Operation]:
        """From event mode into step mode; all that is sent meanwhile."""
        received = operations(self.sent())
        while self.update():
            received += operations(self.sent())
        self.fmu.enterStepMode()
        return received

    def events(self) -> list[Operation]:
        """From step mode through event mode and back."""
        self.fmu.enterEventMode()
        return self.flush()

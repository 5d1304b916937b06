"""Any block as an FMI 2.0 co-simulation slave; runs inside the FMU, on the standard library alone."""

import math
from collections.abc import Callable
from enum import IntEnum
from typing import Any

from . import snapshot
from .integrator import Integrator
from .interface import Variable, interface
from .wrapper import fmi_call

FMI_DISCARD = 2

TICK_TOLERANCE = 1e-3
"""In sample times: a tick this close to a communication point is at it.

Hosts that add up their step sizes instead of counting are off by 1e-8 s after a quarter of an hour.
"""

TIME_TOLERANCE = 1e-6
"""In s: how far the host's time may be from the FMU's."""


class Refused(Exception):
    """A call that changes nothing; the text is what the host logs (the binary takes the repr)."""

    def __repr__(self) -> str:
        return str(self)


class Mode(IntEnum):
    INSTANTIATED = 0
    INITIALIZATION = 1
    STEPPING = 2
    TERMINATED = 3


MODE_NAMES = (
    "before initialization mode",
    "in initialization mode",
    "after initialization",
    "after terminate",
)


class BlockSlave:
    """Mixed into PythonFMU's Fmi2Slave with the class attribute `block`.

    All values are in one list, numbered by value reference: inputs, outputs, parameters. Outputs are
    computed when someone asks for them. Before initialization mode is left there is no state: the
    outputs then are those of the state that the present inputs and parameters would start from.
    """

    block: Any
    log: Callable[..., None]

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.variables = interface(self.block)
        self.first_output = len(self.block.Input._fields)
        self.first_parameter = self.first_output + len(self.block.Output._fields)
        self.values: list[Any] = [v.start for v in self.variables]
        self.bounds = {v.reference: v.bounds() for v in self.variables if v.causality != "output"}
        self.of_type = {
            fmi_type: frozenset(v.reference for v in self.variables if v.fmi_type == fmi_type)
            for fmi_type in ("Real", "Integer", "Boolean", "String")
        }
        if self.block.derivative:
            self.integrator = Integrator(self.block)
        self.mode = Mode.INSTANTIATED
        self.start_time = self.time = 0.0
        self.ticks = 0
        self.x: Any = None
        self._renew()

    def _renew(self) -> None:
        """Makes the records of inputs and parameters from the values; the outputs are out of date."""
        self.u = self.block.Input._make(self.values[: self.first_output])
        if self.x is None:
            self.p = self.block.Parameters._make(self.values[self.first_parameter :])
        self.up_to_date = False

    # Values

    def _get(self, fmi_type: str, references: list[int]) -> list[Any]:
        if not self.of_type[fmi_type].issuperset(references):
            self._refuse_type(fmi_type, references)
        if not self.up_to_date:
            x = self.block.start(self.u, self.p) if self.x is None else self.x
            self.values[self.first_output : self.first_parameter] = self.block.output(x, self.u, self.p)
            self.up_to_date = True
        values = self.values
        return [values[reference] for reference in references]

    def _set(self, fmi_type: str, references: list[int], new: list[Any]) -> None:
        if not self.of_type[fmi_type].issuperset(references):
            self._refuse_type(fmi_type, references)
        bounds = self.bounds
        for reference, value in zip(references, new, strict=True):
            low, high = bounds.get(reference, (1, 0))
            if not low <= value <= high:
                self._judge(self.variables[reference], value)
        for reference, value in zip(references, new, strict=True):
            self.values[reference] = value
        self._renew()

    def _refuse_type(self, fmi_type: str, references: list[int]) -> None:
        """Raises Refused for the first reference that is of another type."""
        wrong = next(r for r in references if r not in self.of_type[fmi_type])
        if wrong >= len(self.variables):
            last = len(self.variables) - 1
            raise Refused(f"value reference {wrong} is unknown; {self.block.name} has 0 to {last}")
        variable = self.variables[wrong]
        raise Refused(f"{variable.name} is of type {variable.fmi_type}, not {fmi_type}")

    def _judge(self, variable: Variable, value: Any) -> None:
        """Raises Refused, unless the variable is an input of a block that copes with any value."""
        name = variable.name
        if variable.causality == "output":
            raise Refused(f"{name} is an output and cannot be set")
        if variable.reference not in self.bounds:
            raise Refused(
                f"{name} = {value!r} is refused {MODE_NAMES[self.mode]}: a parameter is fixed when "
                "initialization mode is left, and an input at terminate; fmi2Reset starts afresh"
            )
        if variable.causality == "input" and self.block.tolerates_bad_input:
            return
        unit = f" {variable.unit}" if variable.unit else ""
        raise Refused(f"{name} = {value!r}{unit} is refused; allowed is {variable.allowed()}")

    @fmi_call
    def get_real(self, vrs: list[int]) -> list[float]:
        return self._get("Real", vrs)

    @fmi_call
    def get_integer(self, vrs: list[int]) -> list[int]:
        return [int(value) for value in self._get("Integer", vrs)]

    @fmi_call
    def get_boolean(self, vrs: list[int]) -> list[bool]:
        return self._get("Boolean", vrs)

    @fmi_call
    def get_string(self, vrs: list[int]) -> list[str]:
        return self._get("String", vrs)

    @fmi_call
    def set_real(self, vrs: list[int], values: list[float]) -> None:
        self._set("Real", vrs, values)

    @fmi_call
    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        self._set("Integer", vrs, values)

    @fmi_call
    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        self._set("Boolean", vrs, values)

    @fmi_call
    def set_string(self, vrs: list[int], values: list[str]) -> None:
        self._set("String", vrs, values)

    # Sequence of a run

    def _require(self, mode: Mode, function: str) -> None:
        if self.mode != mode:
            raise Refused(f"{function} is refused {MODE_NAMES[self.mode]}; its place is {MODE_NAMES[mode]}")

    def _enter(self, mode: Mode) -> None:
        """Changes the mode, and with it what can be set."""
        self.mode = mode
        last = {Mode.STEPPING: self.first_output, Mode.TERMINATED: 0}.get(mode, len(self.variables))
        self.bounds = {v.reference: v.bounds() for v in self.variables[:last] if v.causality != "output"}

    @fmi_call
    def setup_experiment(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:
        self._require(Mode.INSTANTIATED, "fmi2SetupExperiment")
        if not math.isfinite(start_time):
            raise Refused(f"startTime = {start_time!r} s is refused; allowed is any finite number")
        self.start_time = self.time = start_time

    @fmi_call
    def enter_initialization_mode(self) -> None:
        self._require(Mode.INSTANTIATED, "fmi2EnterInitializationMode")
        self._enter(Mode.INITIALIZATION)

    @fmi_call
    def exit_initialization_mode(self) -> None:
        self._require(Mode.INITIALIZATION, "fmi2ExitInitializationMode")
        self.x = self.block.start(self.u, self.p)
        self._enter(Mode.STEPPING)

    @fmi_call
    def terminate(self) -> None:
        self._require(Mode.STEPPING, "fmi2Terminate")
        self._enter(Mode.TERMINATED)

    @fmi_call
    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advances the block; a step that makes no sense is logged and discarded."""
        try:
            self._check_step(current_time, step_size)
        except Refused as refusal:
            self.log(str(refusal), FMI_DISCARD, "logStatusDiscard")
            return False
        end = current_time + step_size
        if self.block.derivative:
            self.x = self.integrator.advance(self.x, self.u, self.p, step_size)
        else:
            self._tick(end)
        self.time = end
        self.up_to_date = False
        return True

    def _check_step(self, current_time: float, step_size: float) -> None:
        self._require(Mode.STEPPING, "fmi2DoStep")
        if not 0.0 < step_size < math.inf:
            raise Refused(
                f"communicationStepSize = {step_size!r} s is refused; allowed is any finite number above 0"
            )
        if not abs(current_time - self.time) <= TIME_TOLERANCE:
            raise Refused(
                f"currentCommunicationPoint = {current_time!r} s is refused; "
                f"{self.block.name} has been computed up to {self.time!r} s"
            )

    def _tick(self, end: float) -> None:
        """All ticks before `end` that have not been made; tick k is due at start_time + k T_s."""
        due = math.ceil((end - self.start_time) / self.block.sample_time - TICK_TOLERANCE)
        x = self.x
        for _ in range(self.ticks, due):
            x = self.block.update(x, self.u, self.p)
        self.x, self.ticks = x, max(self.ticks, due)

    # Saving and restoring; the saved state is its own serialised form

    @fmi_call
    def _get_fmu_state(self) -> bytes:
        held = (*self.u, *self.p)
        return snapshot.pack(
            type(self).__module__, (self.mode, self.start_time, self.time, self.ticks, self.x, held)
        )

    @fmi_call
    def _set_fmu_state(self, state: bytes) -> None:
        try:
            mode, start_time, time, ticks, x, held = snapshot.unpack(type(self).__module__, state)
        except ValueError as error:
            raise Refused(f"the FMU state is refused: {error}") from error
        self.x = None
        self.values[: self.first_output] = held[: self.first_output]
        self.values[self.first_parameter :] = held[self.first_output :]
        self._renew()
        self.x = None if x is None else self.block.State._make(x)
        self.start_time, self.time, self.ticks = start_time, time, ticks
        self._enter(Mode(mode))

    @staticmethod
    def _fmu_state_to_bytes(state: bytes) -> bytes:
        return state

    @staticmethod
    def _fmu_state_from_bytes(state: bytes) -> bytes:
        """Unchecked: an exception here could not be mended by `fmi_call`, so fmi2SetFMUstate checks."""
        return state

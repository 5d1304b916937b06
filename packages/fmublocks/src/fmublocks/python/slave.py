"""Any block as an FMI 2.0 co-simulation slave; runs inside the FMU, on the standard library alone."""

import math
from collections.abc import Callable
from typing import Any
from weakref import ref

from .. import protocol
from ..block.implicit import NotIntegrable
from ..block.integrator import TooMuchWork
from ..block.runner import Runner, runner
from ..protocol import Mode
from . import content
from .refusal import Refused
from .repairs import dismiss_guard, fmi_call, fmi_class_call
from .values import Values

FMI_DISCARD = 2

SETTABLE = {
    Mode.INSTANTIATED: ("input", "parameter"),
    Mode.INITIALIZATION: ("input", "parameter"),
    Mode.STEPPING: ("input", "tunable"),
    Mode.TERMINATED: (),
}
"""Causalities and variabilities that can be set in each mode."""

NAMES = dict(zip(Mode, protocol.MODE_NAMES, strict=True))


class BlockSlave:
    """Mixed into PythonFMU's Fmi2Slave with the class attribute `block`.

    The binary gives every instance a class of its own (see .repairs), whose `instance` it is.

    Before initialization mode is left nothing runs: the outputs then are those of the state that the
    present inputs and parameters would start from.
    """

    block: Any
    instance: ref[Any]
    log: Callable[..., None]

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        type(self).instance = ref(self)
        dismiss_guard(kwargs["resources"], self.block.name)
        self.values = Values(self.block)
        self.mode = Mode.INSTANTIATED
        self.start_time = self.time = 0.0
        self.stop_time = math.inf
        self.runner: Runner | None = None

    @property
    def _x(self) -> Any:
        return self.runner and self.runner.x

    @fmi_call
    def get_real(self, vrs: list[int]) -> list[float]:
        return self.values.get("Real", vrs, self._x)

    @fmi_call
    def get_integer(self, vrs: list[int]) -> list[int]:
        return [int(value) for value in self.values.get("Integer", vrs, self._x)]

    @fmi_call
    def get_boolean(self, vrs: list[int]) -> list[bool]:
        return self.values.get("Boolean", vrs, self._x)

    @fmi_call
    def get_string(self, vrs: list[int]) -> list[str]:
        return self.values.get("String", vrs, self._x)

    @fmi_call
    def set_real(self, vrs: list[int], values: list[float]) -> None:
        self.values.set("Real", vrs, values)

    @fmi_call
    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        self.values.set("Integer", vrs, values)

    @fmi_call
    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        self.values.set("Boolean", vrs, values)

    @fmi_call
    def set_string(self, vrs: list[int], values: list[str]) -> None:
        self.values.set("String", vrs, values)

    def _require(self, mode: Mode, function: str) -> None:
        if self.mode != mode:
            raise Refused(protocol.WRONG_MODE, function=function, mode=NAMES[self.mode], place=NAMES[mode])

    def _enter(self, mode: Mode) -> None:
        self.mode = mode
        self.values.allow(*SETTABLE[mode])

    @fmi_call
    def setup_experiment(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:
        self._require(Mode.INSTANTIATED, "fmi2SetupExperiment")
        if not math.isfinite(start_time):
            raise Refused(protocol.BAD_START_TIME, time=start_time)
        if stop_time is not None and not stop_time >= start_time:
            raise Refused(protocol.BAD_STOP_TIME, time=stop_time, start=start_time)
        self.start_time = self.time = start_time
        self.stop_time = math.inf if stop_time is None else stop_time

    @fmi_call
    def enter_initialization_mode(self) -> None:
        self._require(Mode.INSTANTIATED, "fmi2EnterInitializationMode")
        self._enter(Mode.INITIALIZATION)

    @fmi_call
    def exit_initialization_mode(self) -> None:
        self._require(Mode.INITIALIZATION, "fmi2ExitInitializationMode")
        self.runner = runner(self.block, self.values.u, self.values.p)
        self._enter(Mode.STEPPING)

    @fmi_call
    def terminate(self) -> None:
        self._require(Mode.STEPPING, "fmi2Terminate")
        self._enter(Mode.TERMINATED)

    @fmi_call
    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advances the block; a step that is too long is logged and discarded.

        Raises:
            Refused: no shorter step would do either.
        """
        self._require(Mode.STEPPING, "fmi2DoStep")
        longest = protocol.LONGEST_COMMUNICATION_STEP
        if longest < step_size < math.inf:
            return self._discard(protocol.BAD_STEP_SIZE, size=step_size, longest=longest)
        self._check_step(current_time, step_size)
        try:
            self._advance(step_size)
        except TooMuchWork as failure:
            return self._discard(protocol.TOO_MUCH_WORK, size=step_size, state=failure.args[0])
        self.time = current_time + step_size
        return True

    def _advance(self, step_size: float) -> None:
        """Advances the block, to finite outputs or not at all."""
        assert self.runner
        before, memory = self.runner.x, self.runner.memory
        self.runner.p = self.values.p
        try:
            self.runner.advance(self.values.u, step_size)
            if self.runner.x is not before:
                self.values.up_to_date = False
            self.values.check_outputs(self.runner.x, step_size)
        except (NotIntegrable, TooMuchWork, Refused) as failure:
            self.runner.restore(memory)
            self.values.up_to_date = False
            if not isinstance(failure, NotIntegrable):
                raise
            raise Refused(protocol.NOT_INTEGRABLE, size=step_size, state=failure.args[0]) from None

    def _discard(self, sentence: str, **fields: Any) -> bool:
        """Says why a step was not made that shorter ones can stand for."""
        self.log(sentence.format(**fields), FMI_DISCARD, protocol.LOG_DISCARD)
        return False

    def _check_step(self, current_time: float, step_size: float) -> None:
        if not 0.0 < step_size <= protocol.LONGEST_COMMUNICATION_STEP:
            raise Refused(protocol.BAD_STEP_SIZE, size=step_size, longest=protocol.LONGEST_COMMUNICATION_STEP)
        if not abs(current_time - self.time) <= protocol.TIME_TOLERANCE:
            raise Refused(protocol.BAD_TIME, time=current_time, model=self.block.name, reached=self.time)
        if not (end := current_time + step_size) > current_time:
            raise Refused(protocol.STEP_LOST, size=step_size, time=current_time)
        if end > self.stop_time + protocol.TIME_TOLERANCE:
            raise Refused(protocol.PAST_STOP_TIME, end=end, stop=self.stop_time)

    @fmi_call
    def _get_fmu_state(self) -> bytes:
        """The saved state, which is its own serialised form."""
        memory = self.runner and self.runner.memory
        times = self.start_time, self.stop_time, self.time
        return content.pack(type(self).__module__, (self.mode, *times, self.values.u, self.values.p, memory))

    @fmi_call
    def _set_fmu_state(self, state: bytes) -> None:
        self._restore(content.checked(self.block, content.unpack(type(self).__module__, state)))

    def _restore(self, saved: content.Content) -> None:
        self.values.restore(saved.u, saved.p)
        self.start_time, self.stop_time, self.time, self.runner = saved.start_time, saved.stop_time, saved.time, None
        if saved.memory:
            self.runner = runner(self.block, self.values.u, self.values.p)
            self.runner.restore(saved.memory)
        self._enter(saved.mode)

    @staticmethod
    def _fmu_state_to_bytes(state: bytes) -> bytes:
        return state

    @classmethod
    @fmi_class_call
    def _fmu_state_from_bytes(cls, state: bytes) -> bytes:
        content.checked(cls.block, content.unpack(cls.__module__, state))
        return state

"""An FMU at work: loaded, instantiated, and afterwards gone without a trace."""

import re
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from ctypes import byref, c_int, c_void_p
from functools import partial
from itertools import count
from math import isfinite
from threading import Lock
from typing import Any, cast

import fmpy
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Model,
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    fmi2Discard,
    fmi2Fatal,
    fmi2OK,
    fmi2Pending,
    fmi2Terminated,
    fmi2Warning,
)
from fmpy.fmi3 import _FMU3 as FMU3Base  # pyright: ignore[reportPrivateUsage]
from fmpy.fmi3 import FMU3Model, FMU3Slave
from fmpy.logging import addLoggerProxy
from fmpy.model_description import ModelVariable

from toolground.plain_text import plain

from .call_trace import AT_START, note
from .errors import InstantiationError, SimulationError, WiringError
from .interface import Interface, type_of
from .unpacked_fmu import Unpacked

STATUS = ("ok", "warning", "discard", "error", "fatal", "pending")

MESSAGES_KEPT = 20
_logs: dict[int, deque[tuple[int, str]]] = {}
_keys = count(1)


def _log(environment: int, _name: bytes, status: int, _category: bytes, message: bytes | None) -> None:
    if environment in _logs and message:
        _logs[environment].append((status, plain(message.decode("utf-8", "replace"))))


def _log_of_fmi3(key: int, _environment: int, status: int, category: bytes, message: bytes | None) -> None:
    _log(key, b"", status, category, message)


# one callback for all, never freed: fmpy's proxy, which fills in the arguments of the message, knows one
_logger = fmi2CallbackLoggerTYPE(_log)
blocks = set[int]()
"""Addresses of the memory that FMUs of FMI 2.0 have been given and have not given back."""


def _given(count: int, size: int) -> int | None:
    block = fmpy.calloc(count, size)
    if block:
        blocks.add(block)
    return block


def _given_back(block: int | None) -> None:
    blocks.discard(block or 0)
    fmpy.free(block)


_allocate = fmi2CallbackAllocateMemoryTYPE(_given)
_free = fmi2CallbackFreeMemoryTYPE(_given_back)


def _callbacks(key: int) -> fmi2CallbackFunctions:
    callbacks = fmi2CallbackFunctions()
    callbacks.logger, callbacks.allocateMemory, callbacks.freeMemory = _logger, _allocate, _free
    callbacks.componentEnvironment = key
    addLoggerProxy(byref(callbacks))
    return callbacks


_loading = Lock()
"""fmpy changes the working directory of the process while it loads a binary, so one thread does at a time."""


class _Absent:
    """A function that a binary does not have; only a call of it fails."""

    def __init__(self, name: str) -> None:
        self.name, self.restype = name, None

    def __call__(self, *_: Any) -> None:
        raise AttributeError(f"its binary has no function {self.name}")


class _Traced:
    """What fmpy makes of an FMU, before its class: notes each call, takes a status that FMI does not know for a
    refusal, and does without functions that nobody calls.

    Attributes:
        missing: functions of the standard that its binary does not have.
    """

    missing: Sequence[str] = ()
    dll: Any

    def __init__(self, number: int, **arguments: Any) -> None:
        note(number, "loading its binary")
        self.number = number
        with _loading:
            super().__init__(**arguments)

    def _loadFunctions(self) -> None:
        functions = [name for name in dir(type(self)) if re.fullmatch("fmi[23][A-Z].*", name)]
        self.missing = [name for name in functions if not hasattr(self.dll, name)]
        # fmpy binds all at once, and binaries do without functions that nobody calls
        for name in self.missing:
            setattr(self.dll, name, _Absent(name))
        cast(Any, super())._loadFunctions()

    def _call(self, fname: str, *args: Any) -> Any:
        note(self.number, fname, args[1] if fname in ("fmi2DoStep", "fmi3DoStep") else AT_START)
        result = cast(Any, super())._call(fname, *args)
        # fmpy takes -1 for no refusal
        if cast(Any, self)._functions[fname].restype == c_int and result < fmi2OK:
            raise FMICallException(function=fname, status=result)
        return result


class FMU2Traced(_Traced, FMU2Slave):
    """An FMU of FMI 2.0 for co-simulation. (fmpy looks for FMU2 in the name of the class.)"""

    def start(self, start_time: float, stop_time: float | None, tolerance: float | None = None) -> None:
        """Enters initialization mode."""
        self.setupExperiment(tolerance=tolerance, startTime=start_time, stopTime=stop_time)
        self.enterInitializationMode()

    def has_ended(self) -> bool:
        """Whether it asked for the end of the simulation in the last step, which it discarded."""
        ended = c_int(0)
        component = c_void_p(cast(int, self.component))
        asked = self.dll["fmi2GetBooleanStatus"](component, c_int(fmi2Terminated), byref(ended))
        return asked == fmi2OK and bool(ended)


class FMU2Exchanging(_Traced, FMU2Model):
    """An FMU of FMI 2.0 for model exchange."""

    start = FMU2Traced.start

    def setFloat64(self, references: Sequence[int], values: Sequence[float]) -> None:
        """What FMI 3.0 calls it."""
        cast(Any, self).setReal(references, values)


class _OfFMI3(FMU3Base):
    """An FMU of FMI 3.0, with the names of FMI 2.0 for what goes by another one."""

    getFMUstate = FMU3Base.getFMUState
    setFMUstate = FMU3Base.setFMUState
    freeFMUstate = FMU3Base.freeFMUState
    serializeFMUstate = FMU3Base.serializeFMUState
    deSerializeFMUstate = FMU3Base.deserializeFMUState

    def start(self, start_time: float, stop_time: float | None, tolerance: float | None = None) -> None:
        """Enters initialization mode."""
        self.enterInitializationMode(tolerance=tolerance, startTime=start_time, stopTime=stop_time)


class FMU3Exchanging(_Traced, _OfFMI3, FMU3Model):
    """An FMU of FMI 3.0 for model exchange."""

    newDiscreteStates = FMU3Base.updateDiscreteStates

    def getDerivatives(self, rates: Any, size: int) -> None:
        """What FMI 2.0 calls it."""
        self.getContinuousStateDerivatives(rates, size)

    def sizes(self) -> tuple[int, int]:
        """Numbers of continuous states and of event indicators."""
        return self.getNumberOfContinuousStates(), self.getNumberOfEventIndicators()


class FMU3Traced(_Traced, _OfFMI3, FMU3Slave):
    """An FMU of FMI 3.0 for co-simulation."""

    ended = False

    def doStep(self, *arguments: Any, **named: Any) -> Any:
        """Makes a step; one after which the FMU asks for the end of the simulation is discarded, as in FMI 2.0."""
        answers = super().doStep(*arguments, **named)
        self.ended = answers[1]
        if self.ended:
            raise FMICallException(function="fmi3DoStep", status=fmi2Discard)
        return answers

    def has_ended(self) -> bool:
        """Whether it asked for the end of the simulation in the last step."""
        return self.ended


Slave = FMU2Traced | FMU2Exchanging | FMU3Traced | FMU3Exchanging


class Instance:
    """An instantiated FMU.

    Attributes:
        name: of the instance.
        number: in its loop.
        interface: of its FMU.
        slave: what fmpy made of it.
        status: the worst so far.
        own: whether it is one of the project, which never asks for the end of a run.
    """

    own = False

    def __init__(self, name: str, interface: Interface, slave: Slave, key: int) -> None:
        self.name = name
        self.number = slave.number
        self.interface = interface
        self.slave = slave
        self.status = 0
        self._log = _logs[key]

    def call(self, function: str, *arguments: Any, **named: Any) -> Any:
        """Calls a method of `FMU2Traced` or `FMU3Traced` outside the loop.

        Raises:
            SimulationError: the FMU refused.
        """
        try:
            return getattr(self.slave, function)(*arguments, **named)
        except FMICallException as error:
            raise self.failure(error.function, error.status) from error
        except Exception as error:  # fmpy does not expect every value
            raise SimulationError(f"{self.label}: {function} failed: {plain(error)}") from error

    @property
    def label(self) -> str:
        """What messages call it."""
        return label(self.name, self.interface)

    def reset(self) -> None:
        """Brings it back to where it was after instantiation.

        Raises:
            SimulationError: it cannot; it is of no more use then.
        """
        if self.status >= fmi2Fatal:
            raise SimulationError(f"{self.label} has ended with fatal; load it anew")
        self.call("reset")
        self.status = fmi2OK
        self._log.clear()

    def function(self, name: str) -> Callable[..., int]:
        """The bare function of the shared library: its arguments must be ctypes objects.

        Raises:
            SimulationError: the binary does not have it.
        """
        if name in self.slave.missing:
            raise SimulationError(f"{self.label}: its binary has no function {name}")
        return self.slave.dll[name]

    @property
    def component(self) -> c_void_p:
        return c_void_p(cast(int, self.slave.component))

    def failure(self, function: str, status: int, when: str = "") -> SimulationError:
        """The exception for a refused call, with what the FMU logged about it; `when` as in "at 1 s"."""
        known = 0 <= status < len(STATUS)
        self.status = max(self.status, status) if known else fmi2Fatal
        logged = [message for level, message in self._log if level > fmi2Warning] or [
            message for _, message in self._log
        ]
        return SimulationError(
            f"{self.label} answered {f'{function} {when}'.strip()} with "
            f"{STATUS[status] if known else f'the status {status}, which FMI does not know'}: "
            f"{plain('; '.join(logged)) or ('it works asynchronously' if status == fmi2Pending else 'no message')}"
        )

    def not_finite(self, names: Sequence[str], values: Sequence[float], when: str) -> SimulationError:
        """The exception for NaN or infinity among the values that were read."""
        wrong = [f"{name} is {value}" for name, value in zip(names, values, strict=True) if not isfinite(value)]
        more = f" and {len(wrong) - 1} more" if wrong[1:] else ""
        return SimulationError(f"{self.label}: {wrong[0]}{more} {when}")

    def set_parameters(self, values: Mapping[str, float]) -> None:
        """Sets parameters, one call each, so that a refusal names the one.

        Raises:
            SimulationError: the FMU refused a value.
            WiringError: the value does not suit the type of the parameter.
        """
        for name, value in values.items():
            variable = self.interface.variables[name]
            value = _typed(self.name, name, type_of(variable), value)
            factor = self.interface.factors.get(name, 1.0)
            self.set([variable], [value if factor == 1.0 else value / factor])

    def set(self, variables: Sequence[ModelVariable], values: Sequence[float]) -> None:
        """Sets variables of one type.

        Raises:
            SimulationError: the FMU refused.
        """
        self.call(f"set{self._type_of(variables[0])}", [v.valueReference for v in variables], values)

    def get(self, variables: Sequence[ModelVariable]) -> Sequence[Any]:
        """The values of variables of one type; raises as `set` does."""
        return self.call(f"get{self._type_of(variables[0])}", [v.valueReference for v in variables])

    def _type_of(self, variable: ModelVariable) -> str:
        access = self.interface.access(variable)
        return access.name if access else str(variable.type)


def label(name: str, interface: Interface) -> str:
    """What messages call the instance of that name."""
    return f"{name} ({interface.path.name})"


def _typed(instance: str, name: str, kind: str, value: float) -> float:
    if kind == "Real":
        return float(value)
    if kind == "Boolean" and value not in (0, 1):
        raise WiringError(f"{instance}.{name} = {value:g}: it must be true (1) or false (0)")
    if not (abs(value) < 2**31 and value == int(value)):
        raise WiringError(f"{instance}.{name} = {value:g}: it must be a whole number of less than 2^31")
    return int(value)


TRACED: dict[tuple[int, bool], type[Slave]] = {
    (2, False): FMU2Traced,
    (2, True): FMU2Exchanging,
    (3, False): FMU3Traced,
    (3, True): FMU3Exchanging,
}
"""By FMI, and whether for model exchange."""


@contextmanager
def instantiated(
    name: str, fmu: Unpacked, number: int = 0, exchanging: bool = False, **options: Any
) -> Iterator[Instance]:
    """The FMU as an instance of that name, freed at the end.

    Args:
        number: in its loop.
        exchanging: for model exchange; else for co-simulation.
        options: of fmi3InstantiateCoSimulation, by the names that they have there.

    Raises:
        InstantiationError: it cannot be loaded or instantiated.
    """
    key = next(_keys)
    _logs[key] = deque(maxlen=MESSAGES_KEPT)
    try:
        instance = _instantiate(name, fmu, key, number, exchanging, options)
        try:
            yield instance
        finally:
            # FMI forbids every further call after fmi2Fatal, fmi2FreeInstance too
            if instance.status < fmi2Fatal:
                instance.slave.freeInstance()
    finally:
        del _logs[key]


def _instantiate(
    name: str, fmu: Unpacked, key: int, number: int, exchanging: bool, options: Mapping[str, Any]
) -> Instance:
    interface = fmu.interface
    exchange = interface.description.modelExchange
    try:
        traced = TRACED[interface.fmi, exchanging]
        slave = traced(
            number,
            guid=interface.description.guid,
            unzipDirectory=fmu.folder,
            modelIdentifier=str(exchange.modelIdentifier) if exchanging and exchange else interface.identifier,
            instanceName=name,
        )
        if isinstance(slave, _OfFMI3):
            slave.instantiate(loggingOn=True, logMessage=partial(_log_of_fmi3, key), **options)
        else:
            slave.instantiate(callbacks=_callbacks(key), loggingOn=True)
    except Exception as error:  # fmpy raises bare exceptions
        logged = "; ".join(message for _, message in _logs[key])
        reason = plain(logged or error)
        raise InstantiationError(f"{label(name, interface)} cannot be instantiated: {reason}") from error
    return Instance(name, interface, slave, key)

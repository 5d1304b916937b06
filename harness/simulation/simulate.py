"""One manoeuvre with one loop: the function that everything else runs the loop with."""

import logging
from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from numbers import Real
from sys import float_info
from types import MappingProxyType
from typing import Any, Unpack

import numpy as np

from fmuloop.argument_kinds import require_kind
from fmuloop.campaign import RunRequest
from fmuloop.errors import RunEnded, SimulationError, WiringError
from fmuloop.experiment import Experiment, Source, require_steps
from fmuloop.interface import Interface
from fmuloop.results import Results
from fmuloop.system import Port
from fmuloop.wiring import Fit
from toolground.collected_warnings import warn_once

from ..loop import roles
from ..loop.arguments import A_MANOEUVRE
from ..loop.parameter_words import said
from ..loop.places import T_S, NameOrFile
from ..loop.resolved import ResolvedLoop, as_given
from ..loop.settings import Changes, Settings
from ..loop.topology import ONE_UNIT, Topology
from ..loop.unit_runs import of_unit
from ..manoeuvres.catalogue import MANOEUVRES
from ..manoeuvres.manoeuvre import Manoeuvre
from ..manoeuvres.signals import Signal

LOG = logging.getLogger(__name__)

SHORTEST = 0.2
"""s that a run must have lasted that an FMU has ended: a swing is the peak to peak within so long."""


MOSTLY = 0.5
"""Share of a run without damping that is told."""


def simulate(
    manoeuvre: Manoeuvre, settings: ResolvedLoop | Settings | NameOrFile | None = None, **changes: Unpack[Changes]
) -> Results:
    """Drives the closed loop through a manoeuvre.

    `simulate(tipin)`, `simulate(tipin, "ValidationVehicle", seed=7)` and `simulate(tipin, settings, control=False)`
    are what there is to write: the keyword arguments are the fields of `Settings`.

        results = driveline.simulate(driveline.MANOEUVRES["tipin15"], "ValidationVehicle")
        results["plant.T_gear"]  # in N.m, a sample for each of results["time"]

    Args:
        settings: of the run, or its loop, or only the name or file of its plant; by default those of `Settings()`.
        changes: fields of the settings that are to be others: plant, controller, motor, can, control, parameters,
            frequency, step_size, scheme, seed, folder, build, mapping, limits, tolerance, topology.

    Returns:
        Structured array with the units of its columns: a row for each instant k * step_size, k = 0, 1, ..., with
        `time`, each input (held from that instant on) and each output `instance.variable`. If an FMU ended the run,
        `ended` tells which and when, and the rows are those up to then.

    Raises:
        WiringError: a block, a parameter or an argument does not fit.
        MemoryError: the results of so many steps do not fit in memory.
        SimulationError: an FMU refused a call or ended the run before SHORTEST, or one that was given by its path
            crashed or hung.
    """
    return planned(manoeuvre, settings, **changes).results()


def planned(
    manoeuvre: Manoeuvre, settings: Settings | ResolvedLoop | NameOrFile | None = None, **changes: Unpack[Changes]
) -> RunRequest:
    """The run that `simulate` makes of the same arguments, to be made later, or with others that are like it.

        def settling(k_d, results):
            return driveline.evaluate(results[0], tipin).settling_time

        driveline.run_many(
            settling, gains, runs=lambda k_d: [driveline.planned(tipin, parameters={"controller.k_d": k_d})]
        )

    Raises:
        WiringError: a block, a parameter or an argument does not fit.
        MemoryError: the results of so many steps do not fit in memory.
    """
    require_kind("manoeuvre", manoeuvre, Manoeuvre, A_MANOEUVRE)
    resolved = as_given(settings, **changes)
    made = resolved.runs
    given = _checked(start(manoeuvre, made.seed, made.topology) | dict(made.parameters))
    require_steps(manoeuvre.duration, made.step_size)
    _warn(manoeuvre, given, made.step_size)
    inputs = signals(manoeuvre, made.control, made.step_size, made.topology)
    offered = _offered(manoeuvre, resolved.fit, made.topology)
    experiment = Experiment(
        duration=manoeuvre.duration,
        step_size=made.step_size,
        inputs={**inputs, **offered} if offered else inputs,  # the same mapping where runs are alike
        parameters=given,
        scheme=made.scheme,
        tolerance=made.tolerance,
        label=manoeuvre.name,
    )
    return RunRequest(resolved.fit, experiment, partial(_finished, manoeuvre, resolved))


def _finished(manoeuvre: Manoeuvre, resolved: ResolvedLoop, make: Callable[[], Results]) -> Results:
    """The results of a run, and what there is to say of them."""
    made = resolved.runs
    try:
        results = make()
    except SimulationError as refusal:
        if {"plant.mu", "plant.g_muL", "plant.g_muR"}.isdisjoint(made.parameters) or "omega_wheel_" not in str(refusal):
            raise
        easing = ", ".join(each.name for each in MANOEUVRES.values() if each.road and each is not manoeuvre)
        raise SimulationError(
            f"{refusal}; the wheels spin, as {manoeuvre.name} demands more than the road holds; {easing} ease off"
        ) from None
    if results.ended:
        if results.ended.time < SHORTEST - 1e-9:
            raise RunEnded(f"{results.ended}: there is nothing to evaluate")
        damping = f"with {made.controller_name}" if made.control else "without damping"
        warn_once(f"{results.ended} of {manoeuvre.duration:g} s, in {manoeuvre.name} {damping}: it has no metrics")
    results.frequency = resolved.frequency
    if made.control:
        for unit in made.topology.units:
            controller = resolved.fit.interfaces[unit.instance("controller")]
            _warn_of_fallback(of_unit(results, unit), controller, f"{manoeuvre.name} on {unit.named(made.plant_name)}")
    return results


def _warn_of_fallback(results: Results, controller: Interface, run: str) -> None:
    """Says that the control let go for most of a run, and for which cause, if the controller tells."""
    variables = controller.variables
    types = (variables[name].declaredType for name in ("status", "cause") if name in variables)
    items = [[(int(item.value or 0), str(item.name)) for item in of.items or ()] for of in types if of]
    fallback = [number for number, word in items[0] if word == "fallback"] if len(items) > 1 else []
    cause = results[roles.CAUSE][np.isin(results[roles.STATUS], fallback)].astype(int) if fallback else []
    if len(cause) > MOSTLY * len(results):
        why = dict(items[1]).get(int(np.bincount(cause).argmax()))
        share = 100.0 * len(cause) / len(results)
        warn_once(f"{run}: the damping did not act in {share:.0f} % of the run (status fallback, cause {why})")


def _warn(manoeuvre: Manoeuvre, given: Mapping[str, float], step_size: float) -> None:
    """Names what makes a run that is hardly meant."""
    if given[roles.FIRST_SPEED] > 0.0 and given[roles.FIRST_TORQUE] != manoeuvre.T_0:
        LOG.warning(said("torque", T_0=float(given[roles.FIRST_TORQUE]), demand=float(manoeuvre.T_0)))
    if step_size > T_S * (1.0 + 1e-9):
        warn_once(
            f"the communication step of {step_size * 1e3:g} ms is longer than the {T_S * 1e3:g} ms between samples of "
            "the damping control: it gets its signals late, does not damp with long steps, and the run has no metrics"
        )


def _checked(parameters: dict[str, Any]) -> dict[str, Any]:
    """The parameters, which are finite numbers.

    Raises:
        WiringError: one is none.
    """
    for name, value in parameters.items():
        if not (isinstance(value, Real | np.bool_) and abs(value) <= float_info.max):  # type: ignore[operator]
            raise WiringError(f"{name} = {value!r:.40}: a parameter is a finite number")
    return parameters


@lru_cache(1)
def signals(
    manoeuvre: Manoeuvre, control: bool = True, step_size: float = 0.0, topology: Topology = ONE_UNIT
) -> Mapping[str, Source]:
    """What the loop is given from outside during a manoeuvre; runs that are given the same one are sampled once where
    they are made in lanes.

    The controller samples its inputs at the instants. The plant holds brake and slope for a communication step of
    `step_size` s; it gets what they are in the middle of the step, as straight lines are on average. Held from its
    beginning, they would be late by half a step, and how a car comes to rest depends on that.
    """
    given = {port.name: _value(port, manoeuvre, enable=control) for port in topology.inputs}
    ahead = {name: _ahead(value, 0.5 * step_size) for name, value in given.items() if name.startswith("plant.")}
    return MappingProxyType(given | ahead)


def _offered(manoeuvre: Manoeuvre, fitted: Fit, topology: Topology = ONE_UNIT) -> dict[str, Source]:
    """What a bus tells beside, where the controller has an input for it and no block of the loop tells it."""
    if not manoeuvre.offered:
        return {}
    taken = {connection.target for connection in fitted.system.connections}
    return {
        target: signal
        for controller in topology.instances("controller")
        for name, signal in manoeuvre.offered.items()
        if name in fitted.interfaces[controller].variables and (target := f"{controller}.{name}") not in taken
    }


def _ahead(signal: Signal, time: float) -> Signal:
    """The signal as it is `time` s later."""
    return lambda t: signal(t + time)


def start(manoeuvre: Manoeuvre, seed: int = 1, topology: Topology = ONE_UNIT) -> dict[str, float]:
    """Parameters with which the loop starts a manoeuvre."""
    road = {f"plant.{name}": value for name, value in manoeuvre.road.items()}
    return {port.name: _value(port, manoeuvre, seed=seed) for port in topology.parameters} | road


def _value(port: Port, manoeuvre: Manoeuvre, **settings: Any) -> Any:
    """The setting of that name, or what the manoeuvre has under it."""
    return settings[port.variable] if port.variable in settings else getattr(manoeuvre, port.variable)

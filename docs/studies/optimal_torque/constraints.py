"""A task as a convex programme, for given contacts of the teeth: limits, response, metrics over what is reached.

Everything that the metrics say of the motion is linear in it once the contacts are given, or a norm of what is linear.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from driveline.harness.loop.places import T_S
from driveline.harness.metrics.step_response import REACHED, fitted

from .active_constraints import SWING_RESERVE, ActiveConstraints, settled_swing
from .contacts import GAP, Contacts
from .linear_prediction import Prediction
from .programme import Cone, Programme, Rows, joined
from .task import Task

RESERVE = 2e-3
"""Torque in N.m by which 90 % of the way are exceeded: more than solver and linear car are off by."""

UNIT = {"torque": 1.0, "time": 1e-3, "twist": 0.1}
"""Violations that count as much, in N.m or rad/s, in s, and in phi_B."""


def programme(
    task: Task,
    p: Prediction,
    contacts: Contacts,
    phi_B: float,
    metrics: Sequence[str],
    active: ActiveConstraints,
) -> Programme:
    """The smallest worst ratio of some metrics to those that are reached, with the others no worse.

    Args:
        p: for the contacts.
        phi_B: half the gap in rad.
    """
    final = _final(task, p)
    rows = [*_contact(p, contacts, phi_B), _response(task, p, final), _withheld(task)]
    if active.swings:
        low, high = (p.T_gear(np.arange(len(task.times)))[[*k]] for k in zip(*active.swings, strict=True))
        rows.append(_kept(high - low, settled_swing(task) - SWING_RESERVE, UNIT["torque"]))
    most = {"overshoot": task.reached.overshoot * abs(task.way), "impact_speed": task.reached.impact_speed}
    values = {
        "overshoot": lambda: _overshoot(task, p, final, np.array(active.peaks)),
        "impact_speed": lambda: _closing(p, contacts),
    }
    norms = {"gear_torque_rms": p.T_gear_parts, "jerk_rms_to_50_Hz": p.jerk_parts}
    cones = []
    for name in task.metrics:
        if name in norms:
            cones.append(Cone(norms[name]() / getattr(task.reached, name), name in metrics))
        else:
            rows.append(_at_most(values[name](), most[name], name in metrics))
    return Programme(joined(rows), cones, task.lower, task.upper)


def _at_most(value: np.ndarray, most: float, counts: bool) -> Rows:
    """value <= most times the ratio, or <= most where the metric does not count."""
    m = len(value)
    if counts:
        return Rows(value, np.full(m, most), np.full(m, UNIT["torque"]))
    return _kept(value, most, UNIT["torque"])


def _kept(value: np.ndarray, limit: float, unit: float) -> Rows:
    """value <= limit, whatever the ratio."""
    m, constant = len(value), np.eye(1, value.shape[1])
    return Rows(value - limit * constant, np.zeros(m), np.full(m, unit))


def _contact(p: Prediction, contacts: Contacts, phi_B: float) -> Iterator[Rows]:
    """The twist stays on its side of the flanks; where the side changes it is on the flank."""
    ends = [0, *contacts.ends, len(p.phi) - 1]
    for side, begin, end in zip(contacts.sides, ends[:-1], ends[1:], strict=True):
        phi = p.phi[begin : end + 1]
        if side == GAP:
            yield _kept(phi, phi_B, UNIT["twist"] * phi_B)
            yield _kept(-phi, phi_B, UNIT["twist"] * phi_B)
        else:
            yield _kept(-side * phi, -phi_B, UNIT["twist"] * phi_B)


def _final(task: Task, p: Prediction) -> np.ndarray:
    """The line of the final value: its value at time 0 and its slope."""
    last = np.flatnonzero(fitted(task.times))
    line = np.column_stack([np.ones(len(last)), task.times[last]])
    return np.linalg.pinv(line) @ p.T_gear(last)


def _line(final: np.ndarray, times: np.ndarray) -> np.ndarray:
    return np.column_stack([np.ones(len(times)), times]) @ final


def _response(task: Task, p: Prediction, final: np.ndarray) -> Rows:
    """90 % of the way are made when the controller has made them."""
    at = np.array([task.sample(task.reached.response_delay)])
    way = REACHED * _line(final, np.array([task.manoeuvre.t_0]))
    missing = task.sign * (way - p.T_gear(at))
    return _kept(missing, -(1.0 - REACHED) * task.initial * task.sign - RESERVE, UNIT["torque"])


def _withheld(task: Task) -> Rows:
    """Neither more nor less torque than demanded, by more than the controller withholds."""
    share = T_S / task.dT
    free = task.horizon.free
    withheld = share * np.array([[task.horizon.demand[:free].sum(), *np.full(free, -1.0)]])
    return _kept(np.vstack([withheld, -withheld]), abs(task.reached.withheld_time), UNIT["time"])


def _closing(p: Prediction, contacts: Contacts) -> np.ndarray:
    """Speed with which the teeth meet."""
    return contacts.sides[-1] * p.slip[[contacts.ends[-1]]]


def _overshoot(task: Task, p: Prediction, final: np.ndarray, samples: np.ndarray) -> np.ndarray:
    """Over the line of the final value, in N.m."""
    return task.sign * (p.T_gear(samples) - _line(final, task.times[samples]))

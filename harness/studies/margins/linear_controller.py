"""A controller as a linear sampled system, derived from its own functions where it works in contact.

    x(k+1) = A x(k) + B y(k),    T_ref(k) = C x(k)

The controller runs until it has settled, and there its update is differentiated. What the signals do not reach, and
what does not act on T_ref, is left out. In a sample in which a message with the wheel speed arrives A and B are others.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ....models.controller import T_S
from ....models.controller.supervision import FALLBACK
from .averaged_messages import messages
from .jacobians import NotLinear, like, names, numbers, rates, reached
from .linear_plant import MESSAGE, LinearPlant
from .operating_point import Point

SETTLING = 0.5
"""Time in s for which a controller runs before it is differentiated."""

LAST_DIGIT = 1e-9
"""In rad/s; a motor speed that does not change by a digit is frozen."""

NEEDED = ("T_driver", "omega_1_meas", MESSAGE, "valid", "counter", "enable", "status", "T_max")
"""Inputs, state and parameter of a controller that is settled."""

NOT_MEASURED = ("T_driver", "valid", "counter", "enable", "direction", "alive", "slip_control")
"""Inputs of a controller that carry no measurement."""


class Sample(NamedTuple):
    """What happens in a sample: matrices (n, n) and (n, m)."""

    A: np.ndarray
    B: np.ndarray


class LinearController(NamedTuple):
    """A controller, linear.

    Attributes:
        quiet, message: a sample without a message, and one in which a message arrives.
        C: (n,), T_ref over the state.
        signals: names of the m inputs.
        states: names of the n states.
    """

    quiet: Sample
    message: Sample
    C: np.ndarray
    signals: tuple[str, ...]
    states: tuple[str, ...]

    @property
    def used(self) -> tuple[str, ...]:
        """The signals that do act on T_ref."""
        return tuple(
            name for k, name in enumerate(self.signals) if self.quiet.B[:, k].any() or self.message.B[:, k].any()
        )


def linear_controller(point: Point, drive: LinearPlant) -> LinearController:
    """The controller at a point with this motor and plant.

    Raises:
        NotLinear: it is not linear there.
    """
    return differentiated(point, [settled(point, drive)])[0]


def controller_in_contact_and_gap(point: Point, drive: LinearPlant) -> tuple[LinearController, LinearController]:
    """The same, and with the twist that it knows in the middle of the gap, over the same states."""
    x, u, p = settled(point, drive)
    values = [0.0 if name.endswith("estimate.phi") else value for name, value in zip(names(x), numbers(x), strict=True)]
    known = {name: 0.0 for name in ("phi", "T_gear") if name in u._fields}
    contact, gap = differentiated(point, [(x, u, p), (like(x, values), u._replace(**known), p)])
    return contact, gap


def differentiated(point: Point, places: Sequence[tuple[Any, Any, Any]]) -> list[LinearController]:
    """The controller at some places, each a state, input and parameters, over the same states.

    Raises:
        NotLinear: it has a kink in one of them.
    """
    x, u, p = places[0]
    n, fields = len(numbers(x)), u._fields
    signals = tuple(name for name in fields if name not in NOT_MEASURED)
    inputs = [n + fields.index(name) for name in signals]

    def update(values: Sequence[Any], new: int) -> list[Any]:
        given = u._make(values[n:])._replace(counter=u.counter + new)
        return numbers(point.controller.update(like(x, values[:n]), given, p))

    kinds = [lambda values, new=new: update(values, new) for new in ((0, 1) if point.wheel_speed_in_use else (0,))]
    at = [(kind, [*numbers(x), *u]) for x, u, _ in places for kind in kinds]
    found = [rates(kind, here, [*range(n), *inputs]) for kind, here in at]
    moves = np.any([(each.forward != 0.0) | (each.backward != 0.0) for each in found], axis=0)
    driven, T_ref = reached(moves[:, :n], moves[:, n:].any(axis=1)), np.array([name == "T_ref" for name in names(x)])
    kept = np.flatnonzero(reached((moves[:, :n] & driven & driven[:, None]).T, T_ref & driven))
    columns = [*kept, *range(n, n + len(inputs))]
    labels = [*names(x), *signals]
    for each in found:
        for row, column in np.argwhere(each.has_kink[np.ix_(kept, columns)]):
            raise NotLinear(
                f"{point.controller.name} is not linear in contact at {point.v:g} m/s and {point.T:g} N.m: "
                f"{labels[kept[row]]} has a kink over {labels[columns[column]]}"
            )
    matrices = [each.mean[np.ix_(kept, columns)] for each in found]
    samples = [Sample(matrix[:, : len(kept)], matrix[:, len(kept) :]) for matrix in matrices]
    C, states = T_ref[kept].astype(float), tuple(labels[k] for k in kept)
    each = [samples[k * len(kinds) : (k + 1) * len(kinds)] for k in range(len(places))]
    return [LinearController(kinds[0], kinds[-1], C, signals, states) for kinds in each]


def settled(point: Point, drive: LinearPlant) -> tuple[Any, Any, Any]:
    """State, input and parameters of the controller in a car that speeds up under the torque of the point.

    Raises:
        NotLinear: the controller does not damp there.
    """
    block, p, bus = point.controller, point.of("controller", point.controller), messages(point)
    known = {*block.Input._fields, *block.State._fields, *block.Parameters._fields}
    if lacking := [name for name in NEEDED if name not in known]:
        raise NotLinear(f"{block.name} has no {', '.join(lacking)}; `driveline.supervised` makes controllers that have")
    last = round(SETTLING / T_S)
    given = {name: k for k, name in enumerate(drive.outputs) if name in block.Input._fields}
    # the wheels of the validation vehicle have not settled where its shafts differ; with the car they follow the motor
    motor, rates = given["omega_1_meas"], drive.dy.copy()
    rates[given[MESSAGE]] = drive.dy[motor] * drive.y[given[MESSAGE]] / drive.y[motor]

    def signals(k: int) -> Any:
        measured = {name: float(drive.y[j] + rates[j] * (k - last) * T_S) for name, j in given.items()}
        arrived = k // bus.cycle
        late = (k - arrived * bus.cycle) * T_S + bus.age
        measured[MESSAGE] -= float(rates[given[MESSAGE]]) * late
        measured["omega_1_meas"] += LAST_DIGIT * (k % 2)
        return block.Input(T_driver=point.T, valid=point.wheel_speed_in_use, counter=arrived, enable=True, **measured)

    x = block.start(signals(0), p)
    for k in range(last):
        x = block.update(x, signals(k), p)
    if x.status == FALLBACK:
        raise NotLinear(f"{block.name} does not damp at {point.v:g} m/s and {point.T:g} N.m: it is in fallback")
    return x, signals(last)._replace(counter=(last - 1) // bus.cycle), p

"""Our law at the plant's true motion: what the estimator costs, or gains, at these gains. A mark, and no product.

The law is told the plant's true motion, and T_pred ahead what the estimator's model makes of that. The
supervision has the measured signals, as ever. It is no limit of what can be reached: the gains are those that were
found together with the estimator.
"""

from dataclasses import replace
from typing import Annotated, NamedTuple, cast

from fmublocks.block.declaration import Real, merged
from fmublocks.block.operators import branch, clip, is_finite, logical_and

from ..controller import T_S, damping_law, supervision_interface, torque_estimator
from ..controller.damping_law import LawState
from ..controller.motor_signals import in_range
from ..controller.supervised_controller import Supervised, supervised
from ..controller.torque_estimator import LARGEST_TORQUE, Estimate, EstimatorState
from .fixed import fixed

NO_GAINS = {name: 0.0 for name in torque_estimator.Parameters._fields if name.startswith("L")}

MODEL = fixed(torque_estimator, T_age=T_S, **NO_GAINS)
"""The estimator's model alone: nothing that is measured corrects it."""


class Truth(NamedTuple):
    """What the plant tells beside what is measured."""

    omega_1: Annotated[float, Real("rad/s", "true speed of the motor")] = 0.0
    omega_2: Annotated[float, Real("rad/s", "true speed of the wheels, motor side")] = 0.0
    phi: Annotated[float, Real("rad", "true twist of the drive train, motor side")] = 0.0
    T_gear: Annotated[float, Real("N.m", "true gear torque, motor side")] = 0.0


class AllParameters(torque_estimator.AllParameters):
    """With those of the supervision that it takes beside its own: a type of p, never made."""

    omega_max: float


class WithTrueMotion(Supervised[EstimatorState, LawState]):
    """A controller that gets the true motion of the plant."""

    def estimated(
        self, e: EstimatorState, u: supervision_interface.Input, p: supervision_interface.Parameters
    ) -> EstimatorState:
        return with_true_motion(e, cast(Truth, u), cast(AllParameters, p))


def with_true_motion(expected: EstimatorState, u: Truth, p: AllParameters) -> EstimatorState:
    """The state of the model with the plant's motion; as expected where that is none.

    Its twist is that which makes the true gear torque and, in the gap, the true one. No slip makes it less sure.
    """
    phi = u.T_gear / p.C + clip(u.phi, -p.phi_B, p.phi_B)
    true = expected._replace(base=0.0, estimate=Estimate(u.omega_1, u.omega_2, phi, 0.0), slip=0.0)
    known = logical_and(in_range(u.omega_1, p.omega_max), in_range(u.omega_2, p.omega_max))
    known = logical_and(logical_and(known, is_finite(u.phi)), in_range(u.T_gear, LARGEST_TORQUE * p.T_max))
    return branch(known, lambda: true, lambda: expected)


_CONTROLLER = WithTrueMotion(MODEL, damping_law)

BLOCK = replace(
    supervised(
        name="TrueMotion",
        description="Mark: our damping law, told the plant's true motion",
        module=__name__,
        estimator=MODEL,
        law=damping_law,
    ),
    Input=merged("Input", supervision_interface.Input, Truth),
    start=_CONTROLLER.start,
    update=_CONTROLLER.update,
)

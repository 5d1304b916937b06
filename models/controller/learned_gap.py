"""The half gap phi_B, learned from how the teeth cross it.

The motor meets the true flank where it is; the estimator's model meets the one that it assumes. Where the gap is
wider than assumed the motor goes on faster than the model, where it is narrower slower. So the innovations epsilon
(measured less expected motor speed) are summed up from the moment at which the teeth leave a flank until they have been
on the other one for t_cross. With that time they are forgotten too,

    E <- E + epsilon - T_s/t_cross E
    phi_B <- phi_B + L_phi_B (side (E - E_before) - gap_bias T_max T_s/J_1)

with side 1 for a crossing to the flank that drives, -1 for one to that which brakes, and E_before of the crossing
before. Crossings go to and fro: in the difference a torque that the model always lacks, such as friction, is not left.
gap_bias is what a train that is softer than the model's adds each time. A crossing changes phi_B by MOST_AT_ONCE of it
at most, and all of them together stay within LEAST and MOST of the declared one.

A crossing after which the gear torque is gap_torque T_max tells nothing, one with twice that all; and nothing is
learned where the wheels slip.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real
from fmublocks.block.operators import branch, clip, where

from ..physics.vehicle import CAR, HalfGap, MotorInertia, Stiffness, added_speed
from .gains import GAINS

LEAST, MOST = 0.2, 5.0
"""Of the gap that is learned, over the declared one."""

MOST_AT_ONCE = 0.3
"""Change of the gap by one crossing, over what it was."""


class Parameters(NamedTuple):
    J_1: MotorInertia = CAR.J_1
    C: Stiffness = CAR.C
    phi_B: HalfGap = CAR.phi_B
    phi_B_0: Annotated[
        float, Real("rad", "half gap at the start, as phi_B_hat told it; 0: that of phi_B", 0.0, 5.0)
    ] = 0.0
    L_phi_B: Annotated[
        float, Real("s", "gain of a crossing on phi_B_hat; 0: it is not learned", 0.0, 0.1, tunable=True)
    ] = GAINS["L_phi_B"]
    gap_bias: Annotated[
        float, Real("1", "innovations of a crossing of the right gap, over T_max T_s/J_1", -10.0, 10.0, tunable=True)
    ] = 0.65
    gap_torque: Annotated[
        float,
        Real("1", "gear torque after a crossing of which nothing is learned, over T_max", 1e-3, 1.0, tunable=True),
    ] = 0.03
    t_cross: Annotated[
        float, Real("s", "time for which a crossing tells after the teeth have met", 0.002, 0.2, tunable=True)
    ] = 0.02


class AllParameters(Parameters):
    """With those of the supervision that it takes beside its own: a type of p, never made."""

    T_max: float


class GapState(NamedTuple):
    """What is known of the gap."""

    phi_B: Annotated[float, Real("rad", "half gap")]
    flank: Annotated[float, Real("1", "flank left last, 1 or -1, further from 0 by a sample on the other; 0: unknown")]
    innovations: Annotated[float, Real("rad/s", "sum of the innovations since then")]
    before: Annotated[float, Real("rad/s", "that sum at the end of the crossing before")]


def start(p: Parameters) -> GapState:
    known = where(p.phi_B_0 > 0.0, clip(p.phi_B_0, LEAST * p.phi_B, MOST * p.phi_B), p.phi_B)
    return GapState(known, flank=0.0, innovations=0.0, before=0.0)


def forget_crossing(x: GapState) -> GapState:
    """The state that learns nothing from a crossing that has begun."""
    return x._replace(flank=0.0)


def update(
    x: GapState, innovation: float, phi: float, slip: float, hold: bool, T_s: float, p: AllParameters
) -> tuple[GapState, float]:
    """The state after a sample, and by how much the flank on which the teeth are has moved, rad.

    Args:
        innovation: measured less expected motor speed, rad/s.
        phi: estimated twist, rad.
        slip: how clearly the wheels slip, from 0 to 1; nothing is learned with 1.
        hold: nothing is learned.
    """
    side, depth = where(phi > 0.0, 1.0, -1.0), abs(phi) - x.phi_B
    samples = -side * x.flank  # on the other flank, and one more
    counting = x._replace(innovations=x.innovations + innovation - T_s / p.t_cross * x.innovations)

    def crossed() -> tuple[GapState, float]:
        tells = clip(p.C * depth / (p.gap_torque * p.T_max) - 1.0, 0.0, where(hold, 0.0, 1.0 - slip))
        new = counting.innovations - x.before
        most = MOST_AT_ONCE * x.phi_B
        change = clip(tells * p.L_phi_B * (side * new - p.gap_bias * added_speed(p, T_s)), -most, most)
        phi_B = clip(x.phi_B + change, LEAST * p.phi_B, MOST * p.phi_B)
        return GapState(phi_B, side, 0.0, x.before + tells * new), side * (phi_B - x.phi_B)

    def on_the_other() -> tuple[GapState, float]:
        lasting = samples * T_s > p.t_cross + 0.5 * T_s
        return branch(lasting, crossed, lambda: (counting._replace(flank=x.flank - side), 0.0))

    def touching() -> tuple[GapState, float]:
        return branch(samples > 0.0, on_the_other, lambda: (x._replace(flank=side, innovations=0.0), 0.0))

    return branch(depth >= 0.0, touching, lambda: (counting, 0.0))

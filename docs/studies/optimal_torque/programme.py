"""A convex programme over the torque reference, its solution, and the proof by duality that nothing is better.

    minimise rho   over rho and u, lower <= u <= upper
    subject to     G (1, u) <= a rho,   ||S_i (1, u)|| <= rho or <= 1

rho is a ratio of what is possible to what is reached. Where a = 0 a row is a constraint that has to be kept, and so is
a norm that is to be <= 1.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple
from warnings import catch_warnings, simplefilter

import numpy as np

from fmuloop.errors import SimulationError

from .linear_prediction import value

MOST = 2.0
"""Largest ratio that is looked at."""

PENALTY = 20.0
"""Ratio that violating all constraints by their unit costs: so every programme has a solution, and a bound."""

KEPT = 1e-3
"""Of its unit, by which a constraint may be violated numerically."""

NEGLIGIBLE = 1e-5
"""Over the largest, of singular values of a cone that are left out; that makes the norm no larger."""

SOLVER = {"tol_gap_abs": 1e-5, "tol_gap_rel": 1e-5, "tol_feas": 1e-7, "max_threads": 1, "accept_unknown": True}
"""Settings of Clarabel. The bound holds however accurate the solution is."""


class Rows(NamedTuple):
    """of (m, 1 + n) <= share * rho; share (m,) in the unit of the former, unit (m,) what counts as much as another."""

    of: np.ndarray
    share: np.ndarray
    unit: np.ndarray


class Cone(NamedTuple):
    """||of|| <= rho where it counts, else <= 1; of (m, 1 + n)."""

    of: np.ndarray
    counts: bool


class Programme(NamedTuple):
    """The whole; lower and upper (n,) bound the torque reference in N.m."""

    rows: Rows
    cones: Sequence[Cone]
    lower: np.ndarray
    upper: np.ndarray


class Solution(NamedTuple):
    """The best torque reference among those that are held as long as is asked for.

    Attributes:
        u: (n,) in N.m.
        ratio: that it reaches; inf where the constraints cannot be kept.
        cost: ratio and penalty.
        bound: no torque reference, however it is held, has a smaller ratio.
    """

    u: np.ndarray
    ratio: float
    cost: float
    bound: float


def joined(parts: Sequence[Rows]) -> Rows:
    """All of them as one."""
    return Rows(*map(np.concatenate, zip(*parts, strict=True)))


def solve(programme: Programme, holds: np.ndarray) -> Solution:
    """Solves the programme for a torque that is held from each of the samples `holds` to the next one.

    The torque is taken from the middle of its limits, in units of half their distance.

    Raises:
        SimulationError: the solver gave up.
    """
    import cvxpy as cp  # takes a second, which what is measured without it need not wait

    rows, lower, upper = programme.rows, programme.lower, programme.upper
    middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)

    def held(of: np.ndarray) -> np.ndarray:
        return np.column_stack([value(of, middle), np.add.reduceat(of[:, 1:] * half, holds, axis=1)])

    G, units = held(rows.of), 1.0 / rows.unit
    norms = [_shortened(held(cone.of)) for cone in programme.cones]
    w, rho, sigma = cp.Variable(len(holds)), cp.Variable(nonneg=True), cp.Variable(nonneg=True)
    below = cp.multiply(units, G[:, 1:] @ w + G[:, 0] - rows.share * rho) <= sigma
    within = [
        cp.SOC(rho if cone.counts else 1.0 + sigma, norm[:, 1:] @ w + norm[:, 0])
        for cone, (norm, _) in zip(programme.cones, norms, strict=True)
    ]
    problem = cp.Problem(cp.Minimize(rho + PENALTY * sigma), [below, cp.abs(w) <= 1.0, *within])
    with catch_warnings():
        simplefilter("ignore")  # of inaccurate solutions: ratio and bound are computed from what is found
        try:
            problem.solve(solver=cp.CLARABEL, **SOLVER)
        except cp.SolverError as error:
            raise SimulationError(f"the convex programme was not solved: {error}") from error
    counts = np.diff([*holds, len(lower)])
    u = middle + half * np.clip(np.repeat(_found(w.value), counts), -1.0, 1.0)
    y = np.maximum(units * _found(below.dual_value), 0.0)
    v = [-long @ np.ravel(_found(norm.dual_value)[1]) for norm, (_, long) in zip(within, norms, strict=True)]
    ratio, violated = reached(programme, u)
    cost = ratio + PENALTY * max(violated, 0.0)
    return Solution(u, ratio if violated <= KEPT else np.inf, cost, bound(programme, y, v))


def reached(programme: Programme, u: np.ndarray) -> tuple[float, float]:
    """The ratio that a torque reference reaches, and by how much in its unit it violates a constraint most."""
    rows = programme.rows
    reached_rows, counts = value(rows.of, u), rows.share > 0.0
    norms = [(cone.counts, float(np.linalg.norm(value(cone.of, u)))) for cone in programme.cones]
    ratios = [*(reached_rows[counts] / rows.share[counts]), *(norm for its, norm in norms if its)]
    violations = [*(reached_rows[~counts] / rows.unit[~counts]), *(norm - 1.0 for its, norm in norms if not its)]
    return float(max([0.0, *ratios])), float(max(violations))


def bound(programme: Programme, y: np.ndarray, v: Sequence[np.ndarray]) -> float:
    """The least that the Lagrangian with these multipliers is for lower <= u <= upper, 0 <= rho <= MOST.

    Whatever the multipliers y >= 0 of the rows and v of the cones are, no u that keeps the constraints has a smaller
    ratio (S. Boyd, L. Vandenberghe, Convex Optimization, 2004, section 5.9).

    Args:
        y, v: (rows,), and for each cone (its rows,).
    """
    rows = programme.rows
    lagrangian, of_rho = y @ rows.of, 1.0 - float(y @ rows.share)
    for cone, multiplier in zip(programme.cones, v, strict=True):
        length = float(np.linalg.norm(multiplier))
        lagrangian = lagrangian + multiplier @ cone.of
        lagrangian[0] -= 0.0 if cone.counts else length
        of_rho -= length if cone.counts else 0.0
    constant, gradient = lagrangian[0], lagrangian[1:]
    least = np.minimum(gradient * programme.lower, gradient * programme.upper).sum()
    return float(constant + least + min(of_rho * MOST, 0.0))


def _found(value: Any) -> Any:
    """What the solver has found.

    Raises:
        SimulationError: it has found nothing.
    """
    if value is None:
        raise SimulationError("the convex programme was not solved")
    return value


def _shortened(of: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same norm of fewer rows, and what turns their multipliers into those of all rows."""
    U, S, V = np.linalg.svd(of, full_matrices=False)
    kept = NEGLIGIBLE * S[0] < S
    return S[kept, None] * V[kept], U[:, kept]

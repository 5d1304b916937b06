"""The Runge-Kutta method of the integrator, written out in C."""

import math

from models.block.dop853 import A, B

HEADER = """/* The Runge-Kutta method of order 8 by Dormand and Prince, written by build_fmus.py from dop853.py. */

/* The state `end` a step of length h after x, where its derivative is k0. */
static void step(const Problem *problem, double t, const Vector x, const Vector k0, double h, Vector end)
{{
    Vector at, {stages};
{lines}
}}
"""


def step_header() -> str:
    """dop853.h: the step, operation by operation as the integrator for Python writes it."""
    lines = []
    for stage, weights in enumerate(A[1:], start=1):
        lines += _advanced("at", weights)
        lines.append(f"    rate(problem, t + {math.fsum(weights.values())!r} * h, at, k{stage});")
    lines += _advanced("end", B)
    return HEADER.format(stages=", ".join(f"k{stage}" for stage in range(1, len(A))), lines="\n".join(lines))


def _advanced(to: str, weights: dict[int, float]) -> list[str]:
    """Lines that set `to` to the state advanced by h times the weighted stages."""
    total = " + ".join(f"{weight!r} * k{stage}[n]" for stage, weight in weights.items())
    return ["    for (int n = 0; n < STATES; n++)", f"        {to}[n] = x[n] + h * ({total});".replace("+ -", "- ")]

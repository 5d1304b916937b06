"""The Runge-Kutta methods of the integrator, written out in C."""

import math
from collections.abc import Iterable, Sequence

from ..block import rodas
from ..block.dop853 import B_3, ERROR_5, A, B
from ..block.explicit import GREATEST, TOLERANCE

DOP853 = """/* The Runge-Kutta method of order 8 by Dormand and Prince, written by build_fmus.py from dop853.py. */

/* The state `end` a step of length h after x, where its derivative is k0, and unless it is NULL its error in units of
what is tolerated: NaN or infinite if the end is not finite. */
static void step(const Problem *problem, double t, const Vector x, const Vector k0, double h, Vector end, double *error)
{{
    Point at, {stages};
    Vector sum;
{lines}
    if (!error)
        return;
    double e5 = 0.0, e3 = 0.0;
    for (int n = 0; n < STATES; n++) {{
        const double before = fabs(x[n]), after = fabs(end[n]);
        const double w = {tolerance!r} * ((before > after ? before : after) + small[n]);
        double e = ({error_5}) / w;
        e5 += e * e;
        e = (sum[n] - ({end_3})) / w;
        e3 += e * e;
    }}
    const double d = e5 + 0.01 * e3;
    *error = d > 0.0 && d <= {greatest!r} ? h * e5 / sqrt((double)STATES * d) : {greatest!r} * d;
}}
"""

LANES = """/* The same method for several cars at a time, written from dop853.py. */

static void step_in_lanes(
    const LanesProblem *problem, double t, const LanesVector x, const LanesVector k0, double h, LanesVector end,
    lanes *error)
{{
    struct {{ LanesVector at; }} at, {stages};
    LanesVector sum;
    lanes e5 = {{0}}, e3 = {{0}};
{lines}
    for (int n = 0; n < STATES; n++) {{
        const lanes before = fabs_in_lanes(x[n]), after = fabs_in_lanes(end[n]);
        const lanes w = {tolerance!r} * (chosen(before > after, before, after) + small[n]);
        lanes e = ({error_5}) / w;
        e5 += e * e;
        e = (sum[n] - ({end_3})) / w;
        e3 += e * e;
    }}
    const lanes d = e5 + 0.01 * e3;
    *error = chosen((d > 0.0) & (d <= {greatest!r}), h * e5 / sqrt_in_lanes((double)STATES * d), {greatest!r} * d);
}}
"""

RODAS = """/* The coefficients of RODAS, written by build_fmus.py from rodas.py, which says what they are. */

#define GAMMA {gamma!r}

enum {{ STAGES = {stages} }};

{tables}
"""


def step_header() -> str:
    """dop853.h: the step, operation by operation as explicit.py writes it."""
    return _step(DOP853, "rate_at(problem, t + {time!r} * h, &at, &k{stage})")


def lane_step_header() -> str:
    """lane_dop853.h: the same for several cars at a time."""
    return _step(LANES, "rate_in_lanes(problem, t + {time!r} * h, at.at, k{stage}.at)")


def _step(template: str, rate: str) -> str:
    lines: list[str] = []
    for stage, weights in enumerate(A[1:], start=1):
        lines += _for_each_state(f"at.at[n] = x[n] + h * ({_sum(weights)})")
        lines.append(f"    {rate.format(time=math.fsum(weights.values()), stage=stage)};")
    lines += ["    for (int n = 0; n < STATES; n++) {", f"        sum[n] = {_sum(B)};"]
    lines += ["        end[n] = x[n] + h * sum[n];", "    }"]
    return template.format(
        stages=", ".join(f"k{stage}" for stage in range(1, len(A))),
        lines="\n".join(lines),
        error_5=_sum(ERROR_5),
        end_3=_sum(B_3),
        tolerance=TOLERANCE,
        greatest=GREATEST,
    )


def _for_each_state(statement: str) -> list[str]:
    return ["    for (int n = 0; n < STATES; n++)", f"        {statement};"]


def _sum(weights: dict[int, float]) -> str:
    """The weighted stages of state n."""
    terms = (f"{weight!r} * {f'k{stage}.at' if stage else 'k0'}[n]" for stage, weight in weights.items())
    return " + ".join(terms).replace("+ -", "- ")


def rosenbrock_header() -> str:
    """rodas.h: the coefficients of the implicit method."""
    stages = len(rodas.A)
    tables = [_table(f"{name}[{stages}][{stages}]", map(_braced, getattr(rodas, name))) for name in ("A", "G")]
    tables += [_table(f"{name}[{stages}]", map(repr, getattr(rodas, name))) for name in ("C", "D")]
    return RODAS.format(gamma=rodas.GAMMA, stages=stages, tables="\n\n".join(tables))


def _braced(values: Sequence[float]) -> str:
    return f"{{{', '.join(map(repr, values or (0.0,)))}}}"


def _table(name: str, rows: Iterable[str]) -> str:
    return f"static const double {name} = {{\n" + "".join(f"    {row},\n" for row in rows) + "};"

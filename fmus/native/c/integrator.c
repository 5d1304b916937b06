/* Integrating a continuous block, with its kinks located instead of stepped over.

Between the zeros of its event indicators a block is smooth and the method has order 8. When an indicator
changes sign within a step, the step is shortened so that it ends just behind the zero; an excursion that
leaves and comes back within one step is found from the slopes at both ends. The same as integrator.py, operation by
operation. */
#include "integrator.h"
#include "shared.h"

#include <math.h>
#include <string.h>

enum { INPUTS = sizeof(Input) / sizeof(real), STATES = sizeof(State) / sizeof(real) };

typedef real Vector[STATES];

/* Where a step starts: time since the start of the communication step in s, state, its derivative. */
typedef struct {
    double t;
    Vector x;
    Vector dx;
} Start;

const Input *inputs_at(const Problem *problem, double t, Input *room)
{
    if (!problem->du)
        return problem->u;
    const real *u = (const real *)problem->u, *du = (const real *)problem->du;
    real *at = (real *)room;
    for (int n = 0; n < INPUTS; n++)
        at[n] = u[n] + t * du[n];
    return room;
}

static void rate(const Problem *problem, double t, const Vector x, Vector dx)
{
    Input room;
    derivative((const State *)(const void *)x, inputs_at(problem, t, &room), problem->p, (State *)(void *)dx);
}

#include "dop853.h"

static void begin(const Problem *problem, double t, const Vector x, Start *from)
{
    from->t = t;
    memcpy(from->x, x, sizeof(Vector));
    rate(problem, t, x, from->dx);
}

#if INDICATORS

static void indicators_at(const Problem *problem, double t, const Vector x, real z[INDICATORS])
{
    Input room;
    event_indicators((const State *)(const void *)x, inputs_at(problem, t, &room), problem->p, z);
}

static void sides_at(const Problem *problem, double t, const Vector x, int sides[INDICATORS])
{
    real z[INDICATORS];
    indicators_at(problem, t, x, z);
    for (int n = 0; n < INDICATORS; n++)
        sides[n] = z[n] > 0.0;
}

static void tangent(const Start *from, double h, Vector end)
{
    for (int n = 0; n < STATES; n++)
        end[n] = from->x[n] + h * from->dx[n];
}

static double indicator_at(int n, const Problem *problem, double t, const Vector x)
{
    real z[INDICATORS];
    indicators_at(problem, t, x, z);
    return z[n];
}

/* Indicator n after a step of that length. */
static double value(int n, const Problem *problem, const Start *from, double length)
{
    Vector end;
    step(problem, from->t, from->x, from->dx, length, end);
    return indicator_at(n, problem, from->t + length, end);
}

/* Time derivative of indicator n. */
static double slope(int n, const Problem *problem, const Start *from)
{
    Vector probe;
    tangent(from, PROBE, probe);
    const double here = indicator_at(n, problem, from->t, from->x);
    return (indicator_at(n, problem, from->t + PROBE, probe) - here) / PROBE;
}

/* Length of a step to beyond zero n, if the state goes there and is back before h; else 0. */
static double excursion(int n, const Problem *problem, const Start *from, double h, const Vector end, int side)
{
    Start back;
    begin(problem, from->t + h, end, &back);
    const double here = slope(n, problem, from), there = slope(n, problem, &back);
    if (there * here >= 0.0)
        return 0.0;
    const double turn = h * here / (here - there);
    return (value(n, problem, from, turn) > 0.0) != side ? turn : 0.0;
}

/* Shortest step (to LOCATION_TOLERANCE) that ends beyond zero n; one of length `far` does.

The Illinois variant of regula falsi (M. Dowell, P. Jarratt, BIT 11, 1971): when the same end moves twice, the value at
the other counts half. Three steps without halving the bracket (an indicator on whose zero a block at rest lies is flat
there) are followed by a bisection. */
static double locate(int n, const Problem *problem, const Start *from, double far, int side)
{
    double near = 0.0;
    double z_near = indicator_at(n, problem, from->t, from->x), z_far = value(n, problem, from, far);
    if ((z_near > 0.0) != side)
        z_near = 0.0;
    enum { NONE, NEAR, FAR } moved = NONE;
    int slow = 0;
    while (far - near > LOCATION_TOLERANCE) {
        const double width = far - near;
        const int bisect = slow == 3 || z_far == z_near;
        double length = bisect ? near + 0.5 * width : far - z_far * width / (z_far - z_near);
        const double least = near + 0.3 * LOCATION_TOLERANCE, most = far - 0.3 * LOCATION_TOLERANCE;
        length = length > least ? length : least;
        length = length < most ? length : most;
        const double z = value(n, problem, from, length);
        if ((z > 0.0) != side) {
            far = length;
            z_far = z;
            z_near = moved == FAR ? 0.5 * z_near : z_near;
            moved = FAR;
        } else {
            near = length;
            z_near = z;
            z_far = moved == NEAR ? 0.5 * z_far : z_far;
            moved = NEAR;
        }
        slow = bisect || width >= 2.0 * (far - near) ? 0 : slow + 1;
    }
    return far;
}

/* The first zero crossed within a step of length h to `end`, and the length of the step to it; else -1. */
static int first_crossing(
    const Problem *problem, const Start *from, double h, const Vector end, const int sides[INDICATORS], double *length)
{
    int ends[INDICATORS], straight[INDICATORS], first = -1;
    Vector tip;
    sides_at(problem, from->t + h, end, ends);
    tangent(from, h, tip);
    sides_at(problem, from->t + h, tip, straight);
    for (int n = 0; n < INDICATORS; n++) {
        double beyond = 0.0;
        if (ends[n] != sides[n])
            beyond = h;
        else if (straight[n] != sides[n])
            beyond = excursion(n, problem, from, h, end, sides[n]);
        if (beyond == 0.0)
            continue;
        const double found = locate(n, problem, from, beyond, sides[n]);
        if (first < 0 || found < *length) {
            first = n;
            *length = found;
        }
    }
    return first;
}

/* One step of length h, split at every event on its way.

`sides` says on which side of each zero the state is, and is kept up to date. It is remembered rather than
looked up: at a crossing the value is zero but for rounding. */
static void advance_through(const Problem *problem, double t, double h, Vector x, int sides[INDICATORS])
{
    Start from;
    for (int crossings = 0; crossings < MOST_CROSSINGS; crossings++) {
        Vector end;
        double length = 0.0;
        begin(problem, t, x, &from);
        step(problem, t, from.x, from.dx, h, end);
        const int crossed = first_crossing(problem, &from, h, end, sides, &length);
        if (crossed < 0) {
            memcpy(x, end, sizeof end);
            return;
        }
        step(problem, t, from.x, from.dx, length, x);
        sides[crossed] = !sides[crossed];
        t += length;
        h -= length;
        if (h <= LOCATION_TOLERANCE)
            return;
    }
    begin(problem, t, x, &from);
    step(problem, t, from.x, from.dx, h, x);
}

#endif

void integrate(const Problem *problem, double duration, State *state)
{
    real *x = (real *)state;
    const double steps = fmax(1.0, ceil(duration / LONGEST_STEP - STEP_TOLERANCE));
    const double h = duration / steps;
#if INDICATORS
    int sides[INDICATORS];
    sides_at(problem, 0.0, x, sides);
#endif
    for (double k = 0.0; k < steps; k += 1.0) {
#if INDICATORS
        advance_through(problem, k * h, h, x, sides);
#else
        Start from;
        begin(problem, k * h, x, &from);
        step(problem, from.t, from.x, from.dx, h, x);
#endif
    }
}

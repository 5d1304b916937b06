/* Integrating a continuous block, with its kinks located instead of stepped over.

Between the zeros of its event indicators a block is smooth and the method has order 8. When an indicator
changes sign within a step, the step is shortened so that it ends just behind the zero; an excursion that
leaves and comes back within one step is found from the slopes at both ends. Where the error of a step is more than
is tolerated, the step is divided; where a block is so stiff that very many would be needed, the stretch is left to
an implicit method. Nothing is kept from one stretch to the next. The same as integrator.py, operation by operation. */
#include "integrator.h"
#include "implicit.h"
#include "shared.h"

#include <math.h>
#include <string.h>

enum { NO_CROSSING = -1 };

#if INDICATORS

typedef int Sides[INDICATORS]; /* of each zero: 1 above, 0 below */

static void indicators_at(const Problem *problem, double t, const Vector x, real z[INDICATORS])
{
    Input room;
    State state;
    memcpy(&state, x, sizeof state);
    event_indicators(&state, inputs_at(problem, t, &room), problem->p, z);
}

static void sides_at(const Problem *problem, double t, const Vector x, Sides sides)
{
    real z[INDICATORS];
    indicators_at(problem, t, x, z);
    for (int n = 0; n < INDICATORS; n++)
        sides[n] = z[n] > 0.0;
}

/* Whether an event indicator that was on that side of its zero has crossed it. */
static int is_beyond(double z, int side)
{
    return side ? z < -RESOLUTION : z > RESOLUTION;
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
    make_step_to(problem, from, length, end, NULL);
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
    begin_at(problem, from->t + h, end, &back);
    const double here = slope(n, problem, from), there = slope(n, problem, &back);
    if (there * here >= 0.0)
        return 0.0;
    const double turn = h * here / (here - there);
    return is_beyond(value(n, problem, from, turn), side) ? turn : 0.0;
}

/* Shortest step that ends beyond zero n, to LOCATION_TOLERANCE or RESOLUTION; one of length `far` does.

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
        length = fmin(fmax(length, least), most);
        const double z = value(n, problem, from, length);
        if ((z > 0.0) != side) {
            far = length;
            z_far = z;
            z_near = moved == FAR ? 0.5 * z_near : z_near;
            moved = FAR;
            if (fabs(z) <= RESOLUTION)
                break;
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

/* The first zero crossed within a step of length h to `end`, and the length of the step to it. */
static int first_crossing(
    const Problem *problem, const Start *from, double h, const Vector end, const Sides sides, double *length)
{
    real ends[INDICATORS], straight[INDICATORS];
    int first = NO_CROSSING;
    Vector tip;
    indicators_at(problem, from->t + h, end, ends);
    tangent(from, h, tip);
    indicators_at(problem, from->t + h, tip, straight);
    for (int n = 0; n < INDICATORS; n++) {
        double beyond = 0.0;
        if (is_beyond(ends[n], sides[n]))
            beyond = h;
        else if (is_beyond(straight[n], sides[n]))
            beyond = excursion(n, problem, from, h, end, sides[n]);
        if (beyond == 0.0)
            continue;
        const double found = locate(n, problem, from, beyond, sides[n]);
        if (first == NO_CROSSING || found < *length) {
            first = n;
            *length = found;
        }
    }
    return first;
}

#else

typedef int Sides[1]; /* a block without zeros has none */

static void sides_at(const Problem *problem, double t, const Vector x, Sides sides)
{
    (void)problem, (void)t, (void)x;
    sides[0] = 0;
}

static int first_crossing(
    const Problem *problem, const Start *from, double h, const Vector end, const Sides sides, double *length)
{
    (void)problem, (void)from, (void)h, (void)end, (void)sides, (void)length;
    return NO_CROSSING;
}

#endif

/* Of a change of the state at the start, in units of what is tolerated. */
static double size_of(const Vector way, const Start *from)
{
    double total = 0.0;
    for (int n = 0; n < STATES; n++) {
        const double e = way[n] / (TOLERANCE * (fabs(from->x[n]) + small[n]));
        total += e * e;
    }
    return sqrt(total);
}

/* Whether the state changes too fast for explicit steps.

The fastest rate is found by power iteration from the way of a step that failed: what a small change of the state does
to its derivative is a change that is faster, and the size of that over its own is the rate. */
static int is_stiff(const Problem *problem, const Start *from, const Vector end, double left)
{
    Vector near, there, way;
    for (int n = 0; n < STATES; n++)
        way[n] = end[n] - from->x[n];
    double size = size_of(way, from);
    for (int k = 0; k < POWER_ITERATIONS; k++) {
        if (size == 0.0)
            return 0;
        if (!(size <= GREATEST))
            return 1;
        for (int n = 0; n < STATES; n++)
            near[n] = from->x[n] + way[n] / size;
        rate(problem, from->t, near, there);
        for (int n = 0; n < STATES; n++)
            way[n] = there[n] - from->dx[n];
        size = size_of(way, from);
    }
    return !(left * size <= STIFF);
}

/* A stretch of length `left`, split at every event on its way; as for `integrate`.

`sides` says on which side of each zero the state is, and is kept up to date. It is remembered rather than
looked up: at a crossing the value is zero but for rounding. */
static int advance_through(const Problem *problem, double t, double left, Vector x, Sides sides)
{
    Start from;
    double longest = left;
    int located = 0;
    begin_at(problem, t, x, &from);
    if (*problem->work > MOST_WORK)
        return -(1 + fastest(&from));
    for (int trials = 0; trials < MOST_TRIALS; trials++) {
        Vector end;
        double length = fmin(longest, left), error;
        int crossed = NO_CROSSING;
        make_step_to(problem, &from, length, end, &error);
        if (!(error <= ALLOWED_ERROR) && is_stiff(problem, &from, end, left))
            break;
        if (error <= COARSE_ERROR && located < MOST_CROSSINGS) {
            crossed = first_crossing(problem, &from, length, end, sides, &length);
            if (crossed != NO_CROSSING)
                make_step_to(problem, &from, length, end, &error);
        }
        if (error <= ALLOWED_ERROR) {
            left -= length;
            if (crossed != NO_CROSSING) {
                sides[crossed] = !sides[crossed];
                located++;
            }
            if (left <= LOCATION_TOLERANCE) {
                memcpy(x, end, sizeof end);
                return 0;
            }
            begin_at(problem, from.t + length, end, &from);
        }
        if (crossed == NO_CROSSING || !(error <= ALLOWED_ERROR))
            longest = length * change(error / ALLOWED_ERROR, 3);
    }
    const int failed = integrate_stiff(problem, &from, left);
    memcpy(x, from.x, sizeof from.x);
    sides_at(problem, from.t, x, sides);
    return failed;
}

#ifdef HAS_SOLUTION

/* Whether the state after that time has a solution in closed form. */
static int is_solved(const Problem *problem, double duration, const State *x, State *end)
{
    static const Input held;
    real found[1 + STATES];
    solution(x, problem->u, problem->du ? problem->du : &held, problem->p, duration, found);
    const int holds = found[0] != 0.0;
    if (holds)
        memcpy(end, &found[1], sizeof *end);
    return holds;
}

#else

static int is_solved(const Problem *problem, double duration, const State *x, State *end)
{
    (void)problem, (void)duration, (void)x, (void)end;
    return 0;
}

#endif

int integrate(const Problem *whole, double duration, const State *state, State *end)
{
#ifdef HELD_TERMS
    real held[HELD_TERMS];
    held_terms(whole->u, whole->p, NULL, held);
#else
    real *held = NULL;
#endif
    long work = 0;
    const Problem counted = {whole->u, whole->du, whole->p, &work, held}, *problem = &counted;
    Vector x;
    const double stretches = fmax(1.0, ceil(duration / LONGEST_STEP - STEP_TOLERANCE));
    const double h = duration / stretches;
    Sides sides;
    if (is_solved(whole, duration, state, end))
        return 0;
    memcpy(x, state, sizeof x);
    sides_at(problem, 0.0, x, sides);
    for (double k = 0.0; k < stretches; k += 1.0) {
        const int failed = advance_through(problem, k * h, h, x, sides);
        if (failed)
            return failed;
    }
    memcpy(end, x, sizeof x);
    return 0;
}

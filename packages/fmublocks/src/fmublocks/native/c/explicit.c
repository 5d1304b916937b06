/* Steps of an explicit Runge-Kutta method, and how far off they are. The same as explicit.py, operation by operation;
only here inputs may move. */
#include "explicit.h"
#include "shared.h"

#include <math.h>
#include <string.h>

const Input *inputs_at(const Problem *problem, double t, Input *room)
{
    if (!problem->du)
        return problem->u;
    real u[INPUTS], du[INPUTS];
    memcpy(u, problem->u, sizeof u);
    memcpy(du, problem->du, sizeof du);
    for (int n = 0; n < INPUTS; n++)
        u[n] = u[n] + t * du[n];
    memcpy(room, u, sizeof u);
    return room;
}

static void moving_rate_at(const Problem *problem, double t, const Point *x, Point *dx)
{
    Input room;
    const Input *u = inputs_at(problem, t, &room);
#ifdef HELD_TERMS
    held_terms(u, problem->p, problem->du, problem->held);
    derivative_held(&x->state, u, problem->p, problem->held, &dx->state);
#else
    derivative(&x->state, u, problem->p, &dx->state);
#endif
}

static inline void rate_at(const Problem *problem, double t, const Point *x, Point *dx)
{
#ifdef HELD_TERMS
    if (!problem->du)
        derivative_held(&x->state, problem->u, problem->p, problem->held, &dx->state);
    else
#endif
        moving_rate_at(problem, t, x, dx);
}

void rate(const Problem *problem, double t, const Vector x, Vector dx)
{
    Point point, change;
    memcpy(point.at, x, sizeof point.at);
    rate_at(problem, t, &point, &change);
    memcpy(dx, change.at, sizeof change.at);
}

#include "dop853.h"

void begin_at(const Problem *problem, double t, const Vector x, Start *from)
{
    from->t = t;
    memcpy(from->x, x, sizeof(Vector));
    rate(problem, t, x, from->dx);
}

void make_step_to(const Problem *problem, const Start *from, double length, Vector end, double *error)
{
    ++*problem->work;
    step(problem, from->t, from->x, from->dx, length, end, error);
}

double change(double error, int halvings)
{
    double root = error;
    for (int k = 0; k < halvings; k++)
        root = sqrt(root);
    return fmin(fmax(SAFETY / root, LEAST_CHANGE), MOST_CHANGE); /* fmax takes the number if the other is none */
}

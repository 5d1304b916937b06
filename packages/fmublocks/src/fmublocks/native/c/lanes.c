/* Instances of a block at work in the lanes of vectors: they make the same steps at the same times.

What a car needs alone (an event, a step that must be divided, a solution that does not hold) it gets from the
functions of the single instance. A car that an FMU would refuse something is lost here; its host runs it alone. */
#include "lane_block.h"
#include "instance.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default")))

EXPORT const int lanes_width = WIDTH;

typedef struct {
    LanesInput u;
    LanesOutput y;
    LanesParameters p;
} LanesValues;

typedef struct {
    LanesValues values;
    LanesInput du;
    LanesOutput dy; /* once they have been read */
    LanesState x;
    LanesState coming;
    mask lost;
    Memory cars[WIDTH]; /* as they were loaded; room for what a car does alone */
    double to_tick;
    int outputs_known;
    long alone; /* steps that cars made alone */
} Lanes;

/* The numbers of one car into its lane, or from there. */
static void put_in(lanes *to, int lane, const void *from, size_t size)
{
    const double *numbers = from;
    for (size_t k = 0; k < size / sizeof *numbers; k++)
        to[k][lane] = numbers[k];
}

static void take_out(void *to, const lanes *from, int lane, size_t size)
{
    double *numbers = to;
    for (size_t k = 0; k < size / sizeof *numbers; k++)
        numbers[k] = from[k][lane];
}

#define PUT_IN(to, lane, from) put_in((lanes *)(void *)&(to), lane, &(from), sizeof(from))
#define TAKE_OUT(to, from, lane) take_out(&(to), (const lanes *)(const void *)&(from), lane, sizeof(to))

EXPORT Lanes *lanes_new(void)
{
    Lanes *all = aligned_alloc(sizeof(lanes), (sizeof *all + sizeof(lanes) - 1) / sizeof(lanes) * sizeof(lanes));
    if (all)
        memset(all, 0, sizeof *all);
    return all;
}

EXPORT void lanes_free(Lanes *all)
{
    free(all);
}

/* A car takes its lane, from the saved state of an instance at the end of its initialization; one that does not count
is there because every lane needs one. */
EXPORT void lanes_load(Lanes *all, int lane, const Memory *memory, int counts)
{
    all->cars[lane] = *memory;
    PUT_IN(all->values.u, lane, memory->values.u);
    PUT_IN(all->values.y, lane, memory->values.y);
    PUT_IN(all->values.p, lane, memory->values.p);
    PUT_IN(all->du, lane, memory->du);
    PUT_IN(all->x, lane, memory->x);
    PUT_IN(all->coming, lane, memory->coming);
    all->to_tick = memory->to_tick;
    all->outputs_known = 0;
    all->lost[lane] = counts ? 0 : -1;
}

/* Whether a car is lost. */
EXPORT int lanes_lost(const Lanes *all, int lane)
{
    return all->lost[lane] != 0;
}

/* Steps that cars have made alone. */
EXPORT long lanes_alone(const Lanes *all)
{
    return all->alone;
}

/* Where a variable is. */
EXPORT lanes *lanes_place(Lanes *all, unsigned reference)
{
    return (lanes *)(void *)&all->values + variables[reference].offset / sizeof(double);
}

/* Where its rate of change is, of an input or output. */
EXPORT lanes *lanes_rate(Lanes *all, unsigned reference)
{
    const size_t offset = variables[reference].offset, first = offsetof(Values, y);
    lanes *rates = (lanes *)(void *)(offset < first ? (void *)&all->du : (void *)&all->dy);
    return rates + (offset < first ? offset : offset - first) / sizeof(double);
}

static void check_inputs(Lanes *all)
{
    const lanes *u = (const lanes *)(const void *)&all->values.u;
    for (unsigned k = 0; k < variable_count && variables[k].causality == INPUT && !copes_with_bad_input; k++)
        all->lost |= ~((u[k] >= variables[k].minimum) & (u[k] <= variables[k].maximum));
}

/* Inputs have been set: they are held. */
EXPORT void lanes_set(Lanes *all, double duration)
{
    (void)duration;
    check_inputs(all);
    memset(&all->du, 0, sizeof all->du);
    all->outputs_known = 0;
}

/* The outputs are to be read. */
EXPORT void lanes_outputs(Lanes *all, double duration)
{
    (void)duration;
    LanesValues *values = &all->values;
    const lanes *y = (const lanes *)(const void *)&values->y;
    if (all->outputs_known)
        return;
    lanes_output(&all->x, &values->u, &values->p, &values->y);
    for (size_t k = 0; k < sizeof values->y / sizeof *y && !gives_bad_output; k++)
        all->lost |= ~(fabs_in_lanes(y[k]) <= DBL_MAX);
    all->outputs_known = 1;
}

#ifdef SAMPLE_TIME

/* The same as `advance` of sampled.c. */
EXPORT void lanes_step(Lanes *all, double duration)
{
    all->to_tick -= duration / SAMPLE_TIME;
    const double due = fmax(ceil(-all->to_tick - TICK_TOLERANCE), 0.0);
    for (double k = 0.0; k < due; k += 1.0) {
        all->x = all->coming;
        lanes_update(&all->x, &all->values.u, &all->values.p, &all->coming);
    }
    all->to_tick += due;
    if (all->to_tick <= TICK_TOLERANCE)
        all->x = all->coming;
    all->outputs_known = 0;
}

#else

#include "integrator.h"

typedef lanes LanesVector[STATES];

typedef struct {
    const Lanes *all;
    lanes *held; /* what depends on parameters and inputs alone */
    int moving;  /* whether inputs move */
} LanesProblem;

static void inputs_in_lanes(const Lanes *all, double t, LanesInput *at)
{
    const lanes *u = (const lanes *)(const void *)&all->values.u, *du = (const lanes *)(const void *)&all->du;
    for (int n = 0; n < INPUTS; n++)
        ((lanes *)(void *)at)[n] = u[n] + t * du[n];
}

static void rate_in_lanes(const LanesProblem *problem, double t, const LanesVector x, LanesVector dx)
{
    const Lanes *all = problem->all;
    const LanesState *state = (const LanesState *)(const void *)x;
    const LanesInput *u = &all->values.u;
    LanesInput moved;
    if (problem->moving) {
        inputs_in_lanes(all, t, &moved);
        u = &moved;
    }
#ifdef HELD_TERMS
    if (problem->moving)
        lanes_held_terms(u, &all->values.p, &all->du, problem->held);
    lanes_derivative_held(state, u, &all->values.p, problem->held, (LanesState *)(void *)dx);
#else
    lanes_derivative(state, u, &all->values.p, (LanesState *)(void *)dx);
#endif
}

#include "lane_dop853.h"

#if INDICATORS

static void indicators_in_lanes(const Lanes *all, double t, const LanesVector x, lanes z[INDICATORS])
{
    LanesInput u;
    inputs_in_lanes(all, t, &u);
    lanes_event_indicators((const LanesState *)(const void *)x, &u, &all->values.p, z);
}

static mask is_beyond_in_lanes(lanes z, mask side)
{
    return (side & (z < -RESOLUTION)) | (~side & (z > RESOLUTION));
}

/* The cars that may cross a zero within a step of length h. */
static mask crossing(const Lanes *all, const LanesVector x, const LanesVector dx, double h, const LanesVector end)
{
    lanes start[INDICATORS], ends[INDICATORS], straight[INDICATORS];
    LanesVector tip;
    mask found = {0};
    for (int n = 0; n < STATES; n++)
        tip[n] = x[n] + h * dx[n];
    indicators_in_lanes(all, 0.0, x, start);
    indicators_in_lanes(all, h, end, ends);
    indicators_in_lanes(all, h, tip, straight);
    for (int n = 0; n < INDICATORS; n++) {
        const mask side = start[n] > 0.0;
        found |= is_beyond_in_lanes(ends[n], side) | is_beyond_in_lanes(straight[n], side);
    }
    return found;
}

#else

static mask crossing(const Lanes *all, const LanesVector x, const LanesVector dx, double h, const LanesVector end)
{
    (void)all, (void)x, (void)dx, (void)h, (void)end;
    return (mask){0};
}

#endif

/* The states a step later; returns the cars that cannot make it in one explicit step without an event. */
static mask integrate_in_lanes(const LanesProblem *problem, double duration, LanesVector end)
{
    const Lanes *all = problem->all;
    LanesVector x, dx;
    lanes error;
    memcpy(x, &all->x, sizeof x);
    rate_in_lanes(problem, 0.0, x, dx);
    step_in_lanes(problem, 0.0, x, dx, duration, end, &error);
    return ~(error <= ALLOWED_ERROR) | crossing(all, x, dx, duration, end);
}

/* The states a step later in `end`; returns the cars that make it alone. */
static mask advance_in_lanes(const Lanes *all, double duration, LanesVector end)
{
    const LanesProblem problem = {all, NULL, memcmp(&all->du, &(const LanesInput){{0}}, sizeof all->du) != 0};
#ifdef HAS_SOLUTION
    lanes found[1 + STATES];
    lanes_solution(&all->x, &all->values.u, &all->du, &all->values.p, all_lanes(duration), found);
    memcpy(end, &found[1], sizeof(LanesVector));
    return found[0] == 0.0;
#else
    if (duration > LONGEST_STEP * (1.0 + STEP_TOLERANCE))
        return ~(mask){0};
#ifdef HELD_TERMS
    lanes held[HELD_TERMS];
    lanes_held_terms(&all->values.u, &all->values.p, NULL, held);
    const LanesProblem with_held = {all, held, problem.moving};
    return integrate_in_lanes(&with_held, duration, end);
#else
    return integrate_in_lanes(&problem, duration, end);
#endif
#endif
}

/* The state of one car a step later; returns whether it can be followed. */
static int advance_alone(Lanes *all, int lane, double duration, State *end)
{
    static const Input still;
    Memory *car = &all->cars[lane];
    TAKE_OUT(car->values.u, all->values.u, lane);
    TAKE_OUT(car->du, all->du, lane);
    TAKE_OUT(car->x, all->x, lane);
    const Input *du = memcmp(&car->du, &still, sizeof still) ? &car->du : NULL;
    const Problem problem = {&car->values.u, du, &car->values.p, NULL, NULL};
    return integrate(&problem, duration, &car->x, end) == 0;
}

EXPORT void lanes_step(Lanes *all, double duration)
{
    LanesVector ends;
    const mask alone = advance_in_lanes(all, duration, ends) & ~all->lost;
    EACH_LANE(lane) if (alone[lane]) {
        State end;
        all->alone++;
        if (advance_alone(all, lane, duration, &end))
            put_in(ends, lane, &end, sizeof end);
        else
            all->lost[lane] = -1;
    }
    inputs_in_lanes(all, duration, &all->values.u);
    check_inputs(all);
    memcpy(&all->x, ends, sizeof ends);
    all->outputs_known = 0;
}

/* The rates of change of the outputs are to be read. */
EXPORT void lanes_rates(Lanes *all, double duration)
{
    LanesState dx;
    (void)duration;
    lanes_derivative(&all->x, &all->values.u, &all->values.p, &dx);
    lanes_output_rate(&all->x, &all->values.u, &all->values.p, &dx, &all->du, &all->dy);
}

#endif

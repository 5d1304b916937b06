/* A continuous block as something to integrate, and explicit steps. */
#ifndef EXPLICIT_H
#define EXPLICIT_H

#include "block.h"

enum { INPUTS = sizeof(Input) / sizeof(real), STATES = sizeof(State) / sizeof(real) };

typedef real Vector[STATES]; /* a State, but compilers take them for different things: one is copied to the other */

static const double small[STATES] = SMALL_SIZES; /* what is added to the size of a state */

/* The same, for a function of the block and as numbers. */
typedef union {
    State state;
    Vector at;
} Point;

/* What is integrated: the block with its parameters, and inputs that move at the rates du (NULL if held). */
typedef struct {
    const Input *u;
    const Input *du;
    const Parameters *p;
    long *work;       /* explicit steps that it has come to; kept by integrate */
    real *held;       /* what depends on inputs and parameters alone; kept by integrate */
} Problem;

/* Where a step starts: time since the start of the communication step in s, state, its derivative. */
typedef struct {
    double t;
    Vector x;
    Vector dx;
} Start;

/* The inputs t s after the start of the communication step; `room` is for them if they move. */
static const Input *inputs_at(const Problem *problem, double t, Input *room);

/* The derivative there. */
static void rate(const Problem *problem, double t, const Vector x, Vector dx);
static void begin_at(const Problem *problem, double t, const Vector x, Start *from);

/* A step of that length, and how far off it is unless that is NULL. */
static void make_step_to(const Problem *problem, const Start *from, double length, Vector end, double *error);

/* Length of a step over that of the one before, whose error over what is allowed was that: SAFETY error^(-1/q), but
LEAST_CHANGE to MOST_CHANGE; q, the order of the estimate plus 1, is 2^halvings. */
static double change(double error, int halvings);

#endif

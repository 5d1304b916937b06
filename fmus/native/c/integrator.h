/* Integrating a continuous block. */
#ifndef INTEGRATOR_H
#define INTEGRATOR_H

#include "block.h"

/* What is integrated: the block with its parameters, and inputs that move at the rates du (NULL if held). */
typedef struct {
    const Input *u;
    const Input *du;
    const Parameters *p;
} Problem;

/* Takes the state x to `duration` s later, in equal steps no longer than LONGEST_STEP. */
static void integrate(const Problem *problem, double duration, State *x);

/* The inputs t s after the start of the communication step; `room` is for them if they move. */
static const Input *inputs_at(const Problem *problem, double t, Input *room);

#endif

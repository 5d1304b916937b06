/* Integrating a continuous block. */
#ifndef INTEGRATOR_H
#define INTEGRATOR_H

#include "explicit.h"

/* The state `duration` s after x: by the solution in closed form where it holds, else stretches of at most LONGEST_STEP
are integrated one by one. If it changes too fast to be followed: 1 + the number of the state that changes fastest;
minus that, if shorter communication steps can be made; else 0. */
static int integrate(const Problem *whole, double duration, const State *x, State *end);

#endif

/* Where a block is stiff. */
#ifndef IMPLICIT_H
#define IMPLICIT_H

#include "explicit.h"

/* Takes the state at the start to `duration` s later. If it changes too fast to be followed: 1 + the number of the
state that changes fastest; else 0. */
static int integrate_stiff(const Problem *problem, Start *from, double duration);

/* The number of the state that changes fastest for its size. */
static int fastest(const Start *from);

#endif

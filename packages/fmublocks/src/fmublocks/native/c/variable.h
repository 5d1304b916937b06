/* What is known of a variable of the block; all of them are in variables.h, by value reference. */
#ifndef VARIABLE_H
#define VARIABLE_H

#include "block.h"

#include <stddef.h>

typedef struct {
    Input u;
    Output y;
    Parameters p;
} Values;

typedef enum { REAL, INTEGER, BOOLEAN, STRING, ENUMERATION } Type;

/* Behind the parameters is what follows from the state; RATE: the derivative of a state. */
typedef enum { INPUT, OUTPUT, PARAMETER, STATE, RATE, INDICATOR } Causality;

typedef struct {
    const char *name;
    const char *unit;    /* after a space; empty for none */
    const char *allowed; /* what values it may have, in words */
    Type type;
    Causality causality;
    int tunable;   /* a parameter that can be set during a run */
    size_t offset; /* in Values, of a state or its derivative in State, of an event indicator among these; there all
                      values are real numbers */
    double minimum;
    double maximum;
    double start;
} Variable;

#endif

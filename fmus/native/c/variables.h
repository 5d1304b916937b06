/* The variables of the block as its host sees them, numbered by value reference. */
#ifndef VARIABLES_H
#define VARIABLES_H

#include "block.h"

#include <stddef.h>

typedef struct {
    Input u;
    Output y;
    Parameters p;
} Values;

typedef enum { REAL, INTEGER, BOOLEAN, STRING } Type;

typedef enum { INPUT, OUTPUT, PARAMETER } Causality;

typedef struct {
    const char *name;
    const char *unit;    /* after a space; empty for none */
    const char *allowed; /* what values it may have, in words */
    Type type;
    Causality causality;
    size_t offset; /* in Values; there all values are real numbers */
    double minimum;
    double maximum;
    double start;
} Variable;

#if defined __GNUC__
#pragma GCC visibility push(hidden)
#endif

extern const char *const model_name;
extern const char *const model_guid;
extern const int copes_with_bad_input; /* inputs are not refused */
extern const unsigned variable_count;
extern const Variable variables[];

#if defined __GNUC__
#pragma GCC visibility pop
#endif

#endif

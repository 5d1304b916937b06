#ifndef STATE_H
#define STATE_H

#include "instance.h"

/* A state as bytes: which build it is of, whether it is whole, and what it holds. */
typedef struct {
    char guid[40];
    uint32_t checksum;
    uint32_t unused;
    Memory memory;
} SavedState;

#if defined __GNUC__
#pragma GCC visibility push(hidden)
#endif

fmi2Status get_state(const Instance *instance, fmi2FMUstate *state);
fmi2Status serialize_state(const Instance *instance, fmi2FMUstate state, fmi2Byte bytes[], size_t size);
fmi2Status deserialize_state(const Instance *instance, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state);

#if defined __GNUC__
#pragma GCC visibility pop
#endif

#endif

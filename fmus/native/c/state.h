#ifndef STATE_H
#define STATE_H

#include "instance.h"

/* A state as bytes: whether it is whole, which build it is of, and what it holds. No gaps between the fields. */
typedef struct {
    uint32_t checksum;
    char guid[44];
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

/* The first instance has a place of its own, whose address in the binary is known (FMI-LS-XCP): tools for measurement and
calibration read its memory there, and write parameters. The others are where the host allocates them. */
#include "instance.h"

#include <string.h>

#if defined _WIN32
#define EXPORTED __declspec(dllexport)
#elif defined __GNUC__
#define EXPORTED __attribute__((visibility("default")))
#else
#define EXPORTED
#endif

/* Begins with the memory; behind the instance is what the adapter has. */
EXPORTED union {
    Instance instance;
    unsigned char bytes[sizeof(Instance) + 512];
} FIRST_INSTANCE;

static Parameters known; /* as they were set by calls of the host, or taken over */

#if defined __GNUC__
static int taken;

void *first_place(size_t size)
{
    if (size > sizeof FIRST_INSTANCE || __atomic_exchange_n(&taken, 1, __ATOMIC_ACQ_REL))
        return NULL;
    return memset(&FIRST_INSTANCE, 0, sizeof FIRST_INSTANCE);
}

int left_first_place(const void *component)
{
    if (component != &FIRST_INSTANCE)
        return 0;
    __atomic_store_n(&taken, 0, __ATOMIC_RELEASE);
    return 1;
}
#else
void *first_place(size_t size)
{
    (void)size;
    return NULL;
}

int left_first_place(const void *component)
{
    (void)component;
    return 0;
}
#endif

static int is_first(const Instance *instance)
{
    return (const void *)instance == &FIRST_INSTANCE;
}

void know_parameters(const Instance *instance)
{
    if (is_first(instance))
        known = instance->memory.values.p;
}

void take_over_written(Instance *instance)
{
    Memory *memory = &instance->memory;
    if (!is_first(instance) || memcmp(&memory->values.p, &known, sizeof known) == 0)
        return;
    Values before = memory->values;
    before.p = known;
    for (unsigned k = 0; k < variable_count; k++) {
        const Variable *variable = &variables[k];
        double *written = place_of(&memory->values, variable);
        const double last = *place_of(&before, variable);
        if (variable->causality != PARAMETER || memcmp(written, &last, sizeof last) == 0)
            continue;
        if (variable->type != REAL || !is_allowed(instance, variable, *written))
            *written = last;
    }
    compute_terms(&memory->values.p);
    memory->outputs_known = 0;
    know_parameters(instance);
}

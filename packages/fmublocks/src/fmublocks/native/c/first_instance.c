/* The first instance has a place of its own, whose address in the binary is known: tools for measurement and
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

/* The bytes of the parameters, the last variables, without the terms behind them. */
static size_t size_of_parameters(void)
{
    return variables[variable_count - 1].offset + sizeof(double) - offsetof(Values, p);
}

int has_written(const Instance *instance)
{
    return is_first(instance) && memcmp(&instance->memory.values.p, &known, size_of_parameters()) != 0;
}

void take_back(Instance *instance)
{
    instance->memory.values.p = known;
}

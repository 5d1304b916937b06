/* Model exchange: states, derivatives and event indicators of a continuous block for a host that integrates.

The equations have kinks at the zeros of the indicators, and no jumps. Therefore nothing changes at a state event; it
only tells the host where to start its method anew. */
#include "model_exchange.h"
#include "explicit.h"

#include <float.h>
#include <math.h>
#include <string.h>

static int is_count_of(const Instance *instance, size_t count, size_t right, const char *what)
{
    if (count == right)
        return 1;
    refuse(instance, "%lu %s are refused; %s has %lu", (unsigned long)count, what, model_name, (unsigned long)right);
    return 0;
}

/* Whether values of what is in the table from `first` on are numbers; else they are discarded. */
static int are_numbers(const Instance *instance, const double values[], unsigned first)
{
    for (unsigned k = 0; k < STATES; k++) {
        char text[NUMBER_LENGTH];
        if (fabs(values[k]) <= DBL_MAX)
            continue;
        const Variable *variable = &variables[first + k];
        discard(
            instance, "%s = %s%s is refused; allowed is any finite number", variable->name,
            write_number(text, values[k]), variable->unit);
        return 0;
    }
    return 1;
}

Status get_states(const Instance *instance, double x[], size_t count)
{
    if (!is_count_of(instance, count, STATES, "states"))
        return ERROR;
    const State state = present_state(&instance->memory);
    memcpy(x, &state, sizeof state);
    return OK;
}

Status set_states(Instance *instance, const double x[], size_t count)
{
    if (!is_count_of(instance, count, STATES, "states"))
        return ERROR;
    if (!are_numbers(instance, x, variable_count))
        return DISCARD;
    memcpy(&instance->memory.x, x, sizeof instance->memory.x);
    instance->memory.outputs_known = 0;
    return OK;
}

Status get_rates(const Instance *instance, double dx[], size_t count)
{
    const Memory *memory = &instance->memory;
    Vector rates;
    if (!is_count_of(instance, count, STATES, "derivatives"))
        return ERROR;
    const State x = present_state(memory);
    State dxdt;
    derivative(&x, &memory->values.u, &memory->values.p, &dxdt);
    memcpy(rates, &dxdt, sizeof rates);
    if (!are_numbers(instance, rates, variable_count + STATES))
        return DISCARD;
    memcpy(dx, rates, sizeof rates);
    return OK;
}

Status get_nominals(const Instance *instance, double x_nominal[], size_t count)
{
    static const double nominals[STATES] = NOMINALS;
    if (!is_count_of(instance, count, STATES, "nominal values"))
        return ERROR;
    memcpy(x_nominal, nominals, sizeof nominals);
    return OK;
}

#if INDICATORS > 63
#error "there are more event indicators than bits for the sides on which they are"
#endif

#if INDICATORS

Status get_indicators(const Instance *instance, double z[], size_t count)
{
    if (!is_count_of(instance, count, INDICATORS, "event indicators"))
        return ERROR;
    present_indicators(&instance->memory, z);
    return OK;
}

void update_sides(Instance *instance)
{
    Memory *memory = &instance->memory;
    const State x = present_state(memory);
    real z[INDICATORS];
    event_indicators(&x, &memory->values.u, &memory->values.p, z);
    memory->sides = 0;
    for (int n = 0; n < INDICATORS; n++)
        memory->sides |= (int64_t)(z[n] > 0.0) << n;
}

#else

Status get_indicators(const Instance *instance, double z[], size_t count)
{
    (void)z;
    return is_count_of(instance, count, 0, "event indicators") ? OK : ERROR;
}

void update_sides(Instance *instance)
{
    (void)instance;
}

#endif

Status set_time(Instance *instance, double time)
{
    char text[NUMBER_LENGTH];
    if (!(fabs(time) <= DBL_MAX))
        return refuse(instance, "time = %s s is refused; allowed is any finite number", write_number(text, time));
    instance->memory.time = time;
    return OK;
}

double next_event_time(const Instance *instance)
{
#if TIME_EVENTS
    const Memory *memory = &instance->memory;
    real left[TIME_EVENTS];
    next_event(&memory->x, &memory->values.u, &memory->values.p, left);
    return memory->time + left[0];
#else
    (void)instance;
    return (double)INFINITY;
#endif
}

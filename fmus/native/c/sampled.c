/* A sampled block: computes at whole multiples of its sample time, whatever the communication step. */
#include "instance.h"

#include <math.h>

/* In sample times: a tick this close to a communication point is at it. Hosts that add up their step sizes
   instead of counting are off by 1e-8 s after a quarter of an hour. */
#define TICK_TOLERANCE 1e-3

/* All ticks before `end` that have not been made; tick k is due at start_time + k SAMPLE_TIME. */
void advance(Memory *memory, double end, double duration)
{
    (void)duration;
    const double samples = (end - memory->start_time) / SAMPLE_TIME;
    const double due = ceil(samples - TICK_TOLERANCE);
    const Values *values = &memory->values;
    for (; memory->ticks < due; memory->ticks += 1.0) {
        memory->x = memory->coming;
        update(&memory->x, &values->u, &values->p, &memory->coming);
    }
    if (due - samples <= TICK_TOLERANCE)
        memory->x = memory->coming;
}

fmi2Status check_moving_inputs(Instance *instance, double duration)
{
    (void)instance;
    (void)duration;
    return fmi2OK;
}

static fmi2Status refuse_rates(const Instance *instance, const char *what)
{
    return refuse(instance, "%s is a sampled block and has no %s", model_name, what);
}

fmi2Status set_input_rates(
    Instance *instance, const fmi2ValueReference references[], size_t count, const fmi2Real rates[])
{
    (void)references;
    (void)count;
    (void)rates;
    return refuse_rates(instance, "input derivatives");
}

fmi2Status get_output_rates(
    Instance *instance, const fmi2ValueReference references[], size_t count, fmi2Real rates[])
{
    (void)references;
    (void)count;
    (void)rates;
    return refuse_rates(instance, "output derivatives");
}

fmi2Status get_directional_derivative(
    Instance *instance,
    const fmi2ValueReference unknown[],
    size_t unknowns,
    const fmi2ValueReference known[],
    size_t knowns,
    const fmi2Real change[],
    fmi2Real result[])
{
    (void)unknown;
    (void)unknowns;
    (void)known;
    (void)knowns;
    (void)change;
    (void)result;
    return refuse_rates(instance, "directional derivatives");
}

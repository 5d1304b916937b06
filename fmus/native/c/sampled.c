/* A sampled block: computes at whole multiples of its sample time, whatever the communication step. */
#include "instance.h"

#include <math.h>

/* The ticks up to the end of the step that have not been made; tick k is due k SAMPLE_TIME after the start. The same
as runner.py, operation by operation. */
Obstacle advance(const Memory *memory, double elapsed, double duration, Next *next)
{
    const double samples = (elapsed + duration) / SAMPLE_TIME;
    const double due = ceil(samples - TICK_TOLERANCE);
    const Values *values = &memory->values;
    for (; next->ticks < due; next->ticks += 1.0) {
        State *made = &next->states[next->coming == &next->states[0]];
        next->x = next->coming;
        update(next->x, &values->u, &values->p, made);
        next->coming = made;
    }
    if (next->ticks - samples <= TICK_TOLERANCE)
        next->x = next->coming;
    return (Obstacle){NULL, 0};
}

Status check_ticks(const Instance *instance, const Memory *memory)
{
    const double ticks = memory->ticks, samples = (memory->time - memory->start_time) / SAMPLE_TIME;
    char text[NUMBER_LENGTH];
    if (ticks >= 0.0 && ticks <= MOST_TICKS && ticks == floor(ticks) && fabs(ticks - samples) < 1.5)
        return OK;
    return refuse(instance, BAD_STATE("ticks", write_number(text, ticks), NEAR_ITS_TIME));
}

inline const Input *moving(const Memory *memory)
{
    (void)memory;
    return NULL;
}

Status check_moving_inputs(Instance *instance, double duration)
{
    (void)instance;
    (void)duration;
    return OK;
}

static Status refuse_rates(const Instance *instance, const char *what)
{
    return refuse(instance, "%s is a sampled block and has no %s", model_name, what);
}

Status set_input_rates(Instance *instance, const Reference references[], size_t count, const double rates[])
{
    (void)references;
    (void)count;
    (void)rates;
    return refuse_rates(instance, "input derivatives");
}

Status get_output_rates(const Instance *instance, const Reference references[], size_t count, double rates[])
{
    (void)references;
    (void)count;
    (void)rates;
    return refuse_rates(instance, "output derivatives");
}

Status get_directional_derivative(const Instance *instance, const Direction *direction, double result[])
{
    (void)direction;
    (void)result;
    return refuse_rates(instance, "directional derivatives");
}

/* A sampled block: computes at whole multiples of its sample time, whatever the communication step. */
#include "instance.h"

#include <math.h>

/* The ticks of the step. The same as runner.py, operation by operation. */
Obstacle advance(const Memory *memory, double duration, Next *next)
{
    const Values *values = &memory->values;
    next->to_tick -= duration / SAMPLE_TIME;
    const double due = fmax(ceil(-next->to_tick - TICK_TOLERANCE), 0.0);
    for (double k = 0.0; k < due; k += 1.0) {
        State *made = &next->states[next->coming == &next->states[0]];
        next->x = next->coming;
        update(next->x, &values->u, &values->p, made);
        next->coming = made;
    }
    next->to_tick += due;
    if (next->to_tick <= TICK_TOLERANCE)
        next->x = next->coming;
    return (Obstacle){NULL, 0};
}

Status check_to_tick(const Instance *instance, const Memory *memory)
{
    char text[NUMBER_LENGTH];
    if (fabs(memory->to_tick) <= 1.0)
        return OK;
    return refuse(instance, BAD_STATE("to_tick", write_number(text, memory->to_tick), WITHIN_A_SAMPLE));
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

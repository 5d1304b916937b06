/* A run: from its start through its steps to its end. */
#include "instance.h"

#include <float.h>
#include <math.h>
#include <string.h>

void renew(Instance *instance)
{
    memset(&instance->memory, 0, sizeof instance->memory);
    set_start_values(&instance->memory);
    know_parameters(instance);
    instance->memory.mode = INSTANTIATED;
    instance->memory.stop_time = (double)INFINITY;
}

/* The name of the first of some modes. */
static const char *mode_name(unsigned modes)
{
    static const char *const names[] = MODE_NAMES;
    int k = 0;
    while (!(modes >> k & 1U))
        k++;
    return names[k];
}

int in_mode(const Instance *instance, unsigned modes, const char *function)
{
    const unsigned mode = (unsigned)instance->memory.mode;
    if (mode & modes)
        return 1;
    refuse(instance, WRONG_MODE(function, mode_name(mode), mode_name(modes)));
    return 0;
}

Status set_experiment(Instance *instance, double start_time, double stop_time)
{
    Memory *memory = &instance->memory;
    char text[NUMBER_LENGTH], text_start[NUMBER_LENGTH];
    if (!(fabs(start_time) <= DBL_MAX))
        return refuse(instance, BAD_START_TIME(write_number(text, start_time)));
    if (!(stop_time >= start_time))
        return refuse(instance, BAD_STOP_TIME(write_number(text, stop_time), write_number(text_start, start_time)));
    memory->start_time = memory->time = start_time;
    memory->stop_time = stop_time;
    return OK;
}

void leave_initialization(Instance *instance)
{
    Memory *memory = &instance->memory;
    take_over_written(instance);
    start(&memory->values.u, &memory->values.p, &memory->x);
    memory->coming = memory->x;
    memory->to_tick = 0.0;
    memory->mode = instance->kind == MODEL_EXCHANGE || instance->has_events ? EVENT : STEPPING;
#ifdef TERMINAL
    open_terminal(memory);
#endif
}

static Status check_step(Instance *instance, double time, double step_size)
{
    const double reached = instance->memory.time, end = time + step_size, stop = instance->memory.stop_time;
    char text[NUMBER_LENGTH], other[NUMBER_LENGTH];
    if (!(step_size > 0.0 && step_size <= DBL_MAX))
        return refuse(instance, BAD_STEP_SIZE(write_number(text, step_size), LONGEST_COMMUNICATION_STEP));
    if (step_size > LONGEST_COMMUNICATION_STEP)
        return discard(instance, BAD_STEP_SIZE(write_number(text, step_size), LONGEST_COMMUNICATION_STEP));
    if (!(fabs(time - reached) <= TIME_TOLERANCE))
        return refuse(instance, BAD_TIME(write_number(text, time), model_name, write_number(other, reached)));
    if (!(end > time))
        return refuse(instance, STEP_LOST(write_number(text, step_size), write_number(other, time)));
    if (end > stop + TIME_TOLERANCE)
        return refuse(instance, PAST_STOP_TIME(write_number(text, end), write_number(other, stop)));
    return check_moving_inputs(instance, step_size);
}

/* A step that changes nothing. */
static void stay(const Memory *memory, Next *next)
{
    next->x = &memory->x;
    next->coming = &memory->coming;
    next->u = &memory->values.u;
    next->to_tick = memory->to_tick;
}

/* The memory takes over what a step has changed. `x` first: it may be what was coming. */
static void arrive(Memory *memory, const Next *next, double time)
{
    if (next->x != &memory->x)
        memory->x = *next->x;
    if (next->coming != &memory->coming)
        memory->coming = *next->coming;
    if (next->u != &memory->values.u)
        memory->values.u = *next->u;
    memory->to_tick = next->to_tick;
    memory->time = time;
}

/* What a step leads to takes its place in the memory if it can be followed to finite outputs. */
Status make_step(Instance *instance, double time, double step_size)
{
    Memory *memory = &instance->memory;
    take_over_written(instance);
    Status status = check_step(instance, time, step_size);
    if (status == OK) {
        Next next;
        stay(memory, &next);
        const Obstacle obstacle = advance(memory, step_size, &next);
        char text[NUMBER_LENGTH];
        if (obstacle.state && obstacle.shorter_steps_do)
            status = discard(instance, TOO_MUCH_WORK(write_number(text, step_size), obstacle.state));
        else if (obstacle.state)
            status = refuse(instance, NOT_INTEGRABLE(write_number(text, step_size), obstacle.state));
        else
            status = compute_next_outputs(instance, &next, step_size);
        if (status == OK)
            arrive(memory, &next, time + step_size);
    }
    memory->last_step = status;
    return status;
}

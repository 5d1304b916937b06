/* Whether an instance can have come to what a saved state holds: nothing that was read from bytes is trusted. */
#include "instance.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>

enum { PATH_LENGTH = 200 };

static Status refuse_number(const Instance *instance, const char *name, double value, const char *allowed)
{
    char text[NUMBER_LENGTH];
    return refuse(instance, BAD_STATE(name, write_number(text, value), allowed));
}

static Status check_times(const Instance *instance, const Memory *memory)
{
    if (!(fabs(memory->start_time) <= DBL_MAX))
        return refuse_number(instance, "start_time", memory->start_time, ANY_NUMBER);
    if (!(fabs(memory->time) <= DBL_MAX))
        return refuse_number(instance, "time", memory->time, ANY_NUMBER);
    if ((memory->mode & (INSTANTIATED | INITIALIZATION)) && memory->time != memory->start_time)
        return refuse_number(instance, "time", memory->time, THE_START_TIME);
    if (!(memory->stop_time >= memory->start_time))
        return refuse_number(instance, "stop_time", memory->stop_time, FROM_START_ON);
    return OK;
}

static int is_whole(double value)
{
    return value >= INT_MIN && value <= INT_MAX && value == floor(value);
}

/* Inputs and parameters as they can be set, outputs that are numbers if they are known. */
static Status check_values(const Instance *instance, Memory *memory)
{
    for (unsigned k = 0; k < variable_count; k++) {
        const Variable *variable = &variables[k];
        const double value = *place_of(&memory->values, variable);
        const int whole = is_whole(value);
        const int bounded = variable->causality == PARAMETER || (variable->causality == INPUT && !copes_with_bad_input);
        char text[NUMBER_LENGTH];
        if (variable->causality == OUTPUT && !memory->outputs_known)
            continue;
        if (bounded ? !(value >= variable->minimum && value <= variable->maximum)
                    : variable->causality == OUTPUT && !(fabs(value) <= DBL_MAX))
            return refuse(
                instance,
                BAD_STATE(
                    variable->name, write_value(text, whole ? variable->type : REAL, value),
                    bounded ? variable->allowed : ANY_NUMBER));
        if (variable->type != REAL && !whole)
            return refuse(instance, DAMAGED_STATE);
    }
    return OK;
}

/* Whether a state of the block, or the rates of change of its inputs, are numbers. */
static Status check_numbers(
    const Instance *instance, const char *record, const char *const names[], const double numbers[], size_t count)
{
    for (size_t k = 0; k < count; k++) {
        char path[PATH_LENGTH];
        if (fabs(numbers[k]) <= DBL_MAX)
            continue;
        snprintf(path, sizeof path, "%s%s", record, names[k]);
        return refuse_number(instance, path, numbers[k], ANY_NUMBER);
    }
    return OK;
}

static Status check_states(const Instance *instance, const Memory *memory)
{
    const size_t states = sizeof(State) / sizeof(double);
    const double *x = (const double *)(const void *)&memory->x, *coming = (const double *)(const void *)&memory->coming;
    Status status = check_numbers(instance, "x", state_names, x, states);
    if (status == OK)
        status = check_numbers(instance, "coming", state_names, coming, states);
    return status;
}

const char *kind_name(Kind kind)
{
    return kind == MODEL_EXCHANGE ? "model exchange" : "co-simulation";
}

static int is_exchanged(const Instance *instance, int64_t mode)
{
    return mode == CONTINUOUS_TIME || (mode == EVENT && !instance->has_events);
}

Status check_kind(const Instance *instance, const Memory *memory)
{
    const int exchanged = is_exchanged(instance, memory->mode);
    if (instance->kind == MODEL_EXCHANGE ? memory->mode != STEPPING : !exchanged)
        return OK;
    return refuse(instance, "the FMU state is refused: its instance was made for %s",
                  kind_name(exchanged ? MODEL_EXCHANGE : CO_SIMULATION));
}

Status check_content(const Instance *instance, Memory *memory)
{
    const int64_t mode = memory->mode;
    const int exchanged = is_exchanged(instance, mode);
    if (mode != INSTANTIATED && mode != INITIALIZATION && mode != STEPPING && mode != TERMINATED
        && !(exchanged && allows_model_exchange) && !(mode == EVENT && instance->has_events))
        return refuse(instance, DAMAGED_STATE);
    Status status = check_kind(instance, memory);
    if (status == OK)
        status = check_times(instance, memory);
    if (status == OK)
        status = check_values(instance, memory);
    if (status == OK)
        status = check_numbers(
            instance, "du", input_names, (const double *)(const void *)&memory->du, sizeof(Input) / sizeof(double));
    if (status == OK)
        status = check_to_tick(instance, memory);
    if (status == OK && !(mode & (INSTANTIATED | INITIALIZATION)))
        status = check_states(instance, memory);
#ifdef TERMINAL
    if (status == OK)
        status = check_terminal(instance, &memory->terminal);
#endif
    compute_terms(&memory->values.p);
    return status;
}

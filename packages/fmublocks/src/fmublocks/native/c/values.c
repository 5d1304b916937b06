/* Values by reference, checked when they are set and computed when they are asked for. */
#include "instance.h"

#include <float.h>
#include <math.h>
#include <string.h>

double *place_of(Values *values, const Variable *variable)
{
    return (double *)(void *)((char *)values + variable->offset);
}

double *rate_of(Input *du, const Variable *input)
{
    return (double *)(void *)((char *)du + (input->offset - offsetof(Values, u)));
}

void set_start_values(Memory *memory)
{
    for (unsigned k = 0; k < variable_count; k++)
        *place_of(&memory->values, &variables[k]) = variables[k].start;
    compute_terms(&memory->values.p);
}

Status refuse_reference(const Instance *instance, Reference reference, const char *asked)
{
    char name[NAME_LENGTH];
    if (reference < reference_count)
        return refuse(
            instance, WRONG_TYPE(variables[reference].name, type_names[variables[reference].type], asked));
    if (!instance->host.name_of || !instance->host.name_of(name, reference))
        return refuse(instance, UNKNOWN_REFERENCE(reference, model_name, last_reference));
    if (strcmp(asked, type_names[REAL]) == 0)
        return refuse(instance, "%s has no derivative here, and is none", name);
    return refuse(instance, WRONG_TYPE(name, type_names[REAL], asked));
}

const Variable *variable_of(const Instance *instance, Reference reference, Type type)
{
    if (reference < reference_count && variables[reference].type == type)
        return &variables[reference];
    refuse_reference(instance, reference, type_names[type]);
    return NULL;
}

/* Whether a reference is to a variable of that type among those of the block. */
static int is_own(Reference reference, Type type)
{
    return reference < variable_count && variables[reference].type == type;
}

/* Whether there are arrays, and references to variables of one type in them; else they are refused. */
static int are_of_type(
    const Instance *instance, Type type, const Reference references[], size_t count, const void *values)
{
    if (count > 0 && !(references && values)) {
        refuse(instance, "%u values of type %s, but an array is NULL", (unsigned)count, type_names[type]);
        return 0;
    }
    for (size_t k = 0; k < count; k++)
        if (!variable_of(instance, references[k], type))
            return 0;
    return 1;
}

/* Before the end of initialization mode that which would be started from. */
State present_state(const Memory *memory)
{
    State x = memory->x;
    if (memory->mode & (INSTANTIATED | INITIALIZATION))
        start(&memory->values.u, &memory->values.p, &x);
    return x;
}

#if INDICATORS
/* In the unit of an event indicator: it is beyond its zero by this much when it changes its sign, and never zero. So a
block that rests on a zero, or that a host follows to its tolerance only, does not cross it without end. */
static const double HYSTERESIS = 1e-6;

void present_indicators(const Memory *memory, real z[INDICATORS])
{
    const State x = present_state(memory);
    event_indicators(&x, &memory->values.u, &memory->values.p, z);
    for (int n = 0; n < INDICATORS; n++)
        z[n] += memory->sides >> n & 1 ? HYSTERESIS : -HYSTERESIS;
}
#endif

/* Of a state, of its derivative or of an event indicator. */
static double state_value(const Memory *memory, const Variable *variable)
{
    State record = present_state(memory);
    const char *values = (const char *)&record;
#ifndef SAMPLE_TIME /* the state of a sampled block has no derivative, and is not shown */
    const State x = record;
    if (variable->causality == RATE)
        derivative(&x, &memory->values.u, &memory->values.p, &record);
#endif
#if INDICATORS
    real z[INDICATORS];
    if (variable->causality == INDICATOR) {
        present_indicators(memory, z);
        values = (const char *)z;
    }
#endif
    return *(const double *)(const void *)(values + variable->offset);
}

static void compute_outputs(Memory *memory)
{
    const Values *values = &memory->values;
    const State x = present_state(memory);
    output(&x, &values->u, &values->p, &memory->values.y);
    memory->outputs_known = 1;
}

/* The variable at a place among the outputs. */
static const Variable *output_at(size_t place)
{
    const size_t offset = offsetof(Values, y) + place * sizeof(double);
    const Variable *variable = variables;
    while (variable->offset != offset)
        variable++;
    return variable;
}

Status compute_next_outputs(Instance *instance, const Next *next, double step_size)
{
    Values *values = &instance->memory.values;
    const double *y = (const double *)(const void *)&values->y;
    output(next->x, next->u, &values->p, &values->y);
    for (size_t k = 0; k < sizeof values->y / sizeof *y && !gives_bad_output; k++) {
        char text[NUMBER_LENGTH], size[NUMBER_LENGTH];
        if (fabs(y[k]) <= DBL_MAX)
            continue;
        instance->memory.outputs_known = 0;
        return refuse(
            instance, NOT_FINITE(write_number(size, step_size), output_at(k)->name, write_number(text, y[k])));
    }
    instance->memory.outputs_known = 1;
    return OK;
}

/* Whether outputs are numbers, which no step has made sure of where the host integrates; else they are discarded. */
static int can_be_given(Memory *memory, const Instance *instance, const Reference references[], size_t count)
{
    for (size_t k = 0; k < count && instance->kind == MODEL_EXCHANGE && !gives_bad_output; k++) {
        const Variable *variable = &variables[references[k]];
        const double value = variable->causality == OUTPUT ? *place_of(&memory->values, variable) : 0.0;
        char text[NUMBER_LENGTH];
        if (fabs(value) <= DBL_MAX)
            continue;
        discard(instance, "%s is refused; it would be %s", variable->name, write_number(text, value));
        return 0;
    }
    return 1;
}

static void give(Type type, void *values, size_t k, double value)
{
    if (type == REAL)
        ((double *)values)[k] = value;
    else
        ((int *)values)[k] = (int)value;
}

/* Gets what has to be computed first, or is refused. */
RARE static Status get_others(
    Instance *instance, Type type, const Reference references[], size_t count, void *values)
{
    Memory *memory = &instance->memory;
    if (!are_of_type(instance, type, references, count, values))
        return ERROR;
    for (size_t k = 0; k < count && !memory->outputs_known; k++)
        if (variables[references[k]].causality == OUTPUT)
            compute_outputs(memory);
    if (!can_be_given(memory, instance, references, count))
        return DISCARD;
    for (size_t k = 0; k < count; k++) {
        const Variable *variable = &variables[references[k]];
        give(type, values, k, variable->causality >= STATE ? state_value(memory, variable) : *place_of(&memory->values, variable));
    }
    return OK;
}

/* Where one is refused the values of the others are undefined, as the standard has it. */
Status get_values(Instance *instance, Type type, const Reference references[], size_t count, void *values)
{
    Memory *memory = &instance->memory;
    size_t k = 0;
    if (references && values && memory->outputs_known && instance->kind != MODEL_EXCHANGE)
        for (; k < count && is_own(references[k], type); k++)
            give(type, values, k, *place_of(&memory->values, &variables[references[k]]));
    return k == count ? OK : get_others(instance, type, references, count, values);
}

static double value_at(Type type, const void *values, size_t k)
{
    return type == REAL ? ((const double *)values)[k] : ((const int *)values)[k];
}

static const char *write_value(char text[NUMBER_LENGTH], Type type, double value)
{
    if (type == BOOLEAN && (value == 0.0 || value == 1.0))
        return value == 1.0 ? "True" : "False";
    write_number(text, value);
    if (type != REAL)
        text[strlen(text) - 2] = '\0'; /* a whole number without the .0 */
    return text;
}

/* Whether an input takes a value: beyond its range the end of that is meant, by a host that rounds, or perturbs it to
find derivatives, and where the host integrates by whatever its solver tries. */
static int takes(const Memory *memory, const Variable *variable, double value)
{
    const double slack = variable->type == REAL ? INPUT_TOLERANCE * (variable->maximum - variable->minimum) : 0.0;
    if (copes_with_bad_input || (value >= variable->minimum && value <= variable->maximum))
        return 1;
    if (!(fabs(value) <= DBL_MAX))
        return 0;
    return (memory->mode == CONTINUOUS_TIME && variable->type == REAL)
           || (value >= variable->minimum - slack && value <= variable->maximum + slack);
}

/* Refuses a variable that cannot be set to a value now. */
static Status judge(const Instance *instance, const Variable *variable, double value)
{
    const int64_t mode = instance->memory.mode;
    const int started = (mode & (INSTANTIATED | INITIALIZATION)) == 0;
    const int late = mode == TERMINATED
                     || (started && variable->causality == PARAMETER
                         && !(variable->tunable && (mode & (STEPPING | EVENT)) != 0));
    const int good = value >= variable->minimum && value <= variable->maximum;
    const char *name = variable->name;
    char text[NUMBER_LENGTH];
    if (variable->causality == OUTPUT)
        return refuse(instance, OUTPUT_SET(name));
    if (variable->causality >= STATE)
        return refuse(instance, "%s belongs to the state and cannot be set as a variable", name);
    if (late)
        return refuse(instance, SET_TOO_LATE(name, write_value(text, variable->type, value)));
    if (variable->causality == INPUT ? takes(&instance->memory, variable, value) : good)
        return OK;
    write_value(text, variable->type, value);
    if (variable->causality == PARAMETER)
        return discard(instance, BAD_VALUE(name, text, variable->unit, variable->allowed));
    return refuse(instance, BAD_VALUE(name, text, variable->unit, variable->allowed));
}

static double within(const Variable *variable, double value)
{
    if (variable->causality != INPUT || copes_with_bad_input)
        return value;
    return value < variable->minimum ? variable->minimum : value > variable->maximum ? variable->maximum : value;
}

static void put(Memory *memory, Type type, const Reference references[], size_t count, const void *values)
{
    for (size_t k = 0; k < count; k++) {
        const double value = value_at(type, values, k);
        const Variable *variable = &variables[references[k]];
        *place_of(&memory->values, variable) = type == BOOLEAN ? value != 0.0 : within(variable, value);
    }
    memory->outputs_known = 0;
}

/* Sets parameters, or refuses what cannot be set. */
RARE static Status set_others(
    Instance *instance, Type type, const Reference references[], size_t count, const void *values)
{
    if (!are_of_type(instance, type, references, count, values))
        return ERROR;
    for (size_t k = 0; k < count; k++) {
        const Status status = judge(instance, &variables[references[k]], value_at(type, values, k));
        if (status != OK)
            return status;
    }
    take_over_written(instance);
    put(&instance->memory, type, references, count, values);
    compute_terms(&instance->memory.values.p);
    know_parameters(instance);
    return OK;
}

Status set_values(Instance *instance, Type type, const Reference references[], size_t count, const void *values)
{
    Memory *memory = &instance->memory;
    size_t k = 0;
    if (references && values && memory->mode != TERMINATED)
        while (k < count && is_own(references[k], type)
               && variables[references[k]].causality == INPUT
               && takes(memory, &variables[references[k]], value_at(type, values, k)))
            k++;
    if (k < count)
        return set_others(instance, type, references, count, values);
    put(memory, type, references, count, values);
    return OK;
}

void take_over_written(Instance *instance)
{
    if (!has_written(instance))
        return;
    Values *values = &instance->memory.values, written = *values;
    take_back(instance);
    for (Reference k = 0; k < variable_count; k++) {
        const double *value = place_of(&written, &variables[k]), *last = place_of(values, &variables[k]);
        if (variables[k].type == REAL && variables[k].causality == PARAMETER && memcmp(value, last, sizeof *value))
            set_values(instance, REAL, &k, 1, value);
    }
}

/* A continuous block: its steps, and its rates of change. */
#include "instance.h"
#include "integrator.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const Input *moving(const Memory *memory)
{
    uint64_t rates[INPUTS], any = 0;
    memcpy(rates, &memory->du, sizeof rates);
    for (int n = 0; n < INPUTS; n++)
        any |= rates[n];
    return any ? &memory->du : NULL;
}

Obstacle advance(const Memory *memory, double duration, Next *next)
{
    const Values *values = &memory->values;
    const Problem problem = {&values->u, moving(memory), &values->p, NULL, NULL};
    const int failed = integrate(&problem, duration, &memory->x, &next->states[0]);
    if (failed)
        return (Obstacle){state_names[abs(failed) - 1] + 1, failed < 0}; /* without the dot of the name */
    next->x = &next->states[0];
    if (problem.du)
        next->u = inputs_at(&problem, duration, &next->inputs);
    return (Obstacle){.state = NULL};
}

Status check_to_tick(const Instance *instance, const Memory *memory)
{
    (void)instance;
    (void)memory;
    return OK;
}

Status check_moving_inputs(Instance *instance, double duration)
{
    Memory *memory = &instance->memory;
    for (unsigned k = 0; moving(memory) && k < variable_count && variables[k].causality == INPUT; k++) {
        const Variable *variable = &variables[k];
        const double end = *place_of(&memory->values, variable) + duration * *rate_of(&memory->du, variable);
        char text[NUMBER_LENGTH];
        if (!(end >= variable->minimum && end <= variable->maximum))
            return refuse(
                instance, "%s = %s%s at the end of the step is refused; allowed is %s", variable->name,
                write_number(text, end), variable->unit, variable->allowed);
    }
    return OK;
}

Status set_input_rates(Instance *instance, const Reference references[], size_t count, const double rates[])
{
    for (size_t k = 0; k < count; k++) {
        const Variable *variable = variable_of(instance, references[k], REAL);
        char text[NUMBER_LENGTH];
        if (!variable)
            return ERROR;
        if (variable->causality != INPUT)
            return refuse(instance, "%s is not an input and has no input derivative", variable->name);
        if (!(fabs(rates[k]) <= DBL_MAX))
            return refuse(
                instance, "%s is refused as derivative of %s; allowed is any finite number",
                write_number(text, rates[k]), variable->name);
    }
    for (size_t k = 0; k < count; k++)
        *rate_of(&instance->memory.du, &variables[references[k]]) = rates[k];
    return OK;
}

/* Rates of change, or small changes, of all that a reference can name. */
typedef struct {
    Values values;
    State x;
    State dx;
} Changes;

static double *change_of(Changes *changes, const Variable *variable)
{
    char *record = (char *)(variable->causality == STATE ? &changes->x : &changes->dx);
    const int of_state = variable->causality == STATE || variable->causality == RATE;
    return of_state ? (double *)(void *)(record + variable->offset) : place_of(&changes->values, variable);
}

/* Gives out rates or changes if all are numbers; else they are refused. */
static Status give_out(
    const Instance *instance, const Reference references[], size_t count, Changes *changes, double results[])
{
    for (size_t k = 0; k < count; k++) {
        const Variable *variable = &variables[references[k]];
        const double change = *change_of(changes, variable);
        char text[NUMBER_LENGTH];
        if (!(fabs(change) <= DBL_MAX))
            return refuse(
                instance, "the derivative of %s is refused; it would be %s", variable->name, write_number(text, change));
    }
    for (size_t k = 0; k < count; k++)
        results[k] = *change_of(changes, &variables[references[k]]);
    return OK;
}

Status get_output_rates(const Instance *instance, const Reference references[], size_t count, double rates[])
{
    const Memory *memory = &instance->memory;
    const Values *values = &memory->values;
    Changes changes;
    State dx;
    for (size_t k = 0; k < count; k++) {
        const Variable *variable = variable_of(instance, references[k], REAL);
        if (!variable)
            return ERROR;
        if (variable->causality != OUTPUT)
            return refuse(instance, "%s is not an output and has no output derivative", variable->name);
    }
    derivative(&memory->x, &values->u, &values->p, &dx);
    output_rate(&memory->x, &values->u, &values->p, &dx, &memory->du, &changes.values.y);
    return give_out(instance, references, count, &changes, rates);
}

/* Whether a variable can take part in a directional derivative: as unknown an output or the derivative of a state, as
known an input or a state; until initialization mode is left a state is an unknown, and a parameter a known. */
static int is_differentiable(const Instance *instance, Reference reference, int unknown)
{
    const Variable *variable = variable_of(instance, reference, REAL);
    if (!variable)
        return 0;
    const Causality causality = variable->causality;
    const int tuning = instance->memory.mode == INITIALIZATION;
    if (unknown ? causality == OUTPUT || causality == RATE || (causality == STATE && tuning)
                : causality == INPUT || causality == (tuning ? PARAMETER : STATE))
        return 1;
    refuse(
        instance,
        "%s cannot be %s of a directional derivative; allowed is any %s",
        variable->name,
        unknown ? "the unknown" : "a known",
        unknown ? tuning ? "output, state or its derivative" : "output or derivative of a state"
        : tuning ? "input or parameter"
                 : "input or state");
    return 0;
}

Status get_directional_derivative(const Instance *instance, const Direction *direction, double result[])
{
    const Memory *memory = &instance->memory;
    const Values *values = &memory->values;
    static const Changes unchanged;
    Changes changes = unchanged;
    for (size_t k = 0; k < direction->unknowns; k++)
        if (!is_differentiable(instance, direction->unknown[k], 1))
            return ERROR;
    for (size_t k = 0; k < direction->knowns; k++) {
        const double change = direction->change[k];
        char text[NUMBER_LENGTH];
        if (!is_differentiable(instance, direction->known[k], 0))
            return ERROR;
        const Variable *known = &variables[direction->known[k]];
        if (!(fabs(change) <= DBL_MAX))
            return refuse(
                instance, "%s is refused as change of %s; allowed is any finite number", write_number(text, change),
                known->name);
        *change_of(&changes, known) += change;
    }
    Values *dv = &changes.values;
    const State x = present_state(memory);
    if (memory->mode == INITIALIZATION) {
        start_tangent(&values->u, &values->p, &dv->u, &dv->p, &changes.x);
        output_tangent(&x, &values->u, &values->p, &changes.x, &dv->u, &dv->p, &dv->y);
    } else
        output_rate(&x, &values->u, &values->p, &changes.x, &dv->u, &dv->y);
    derivative_tangent(&x, &values->u, &values->p, &changes.x, &dv->u, &dv->p, &changes.dx);
    return give_out(instance, direction->unknown, direction->unknowns, &changes, result);
}

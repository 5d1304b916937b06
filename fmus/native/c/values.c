/* Values by value reference, checked when they are set and computed when they are asked for. */
#include "instance.h"

#include <string.h>

static const char *const type_names[] = {"Real", "Integer", "Boolean", "String"};

void set_start_values(Memory *memory)
{
    for (unsigned k = 0; k < variable_count; k++)
        *place_of(&memory->values, &variables[k]) = variables[k].start;
}

double *place_of(Values *values, const Variable *variable)
{
    return (double *)(void *)((char *)values + variable->offset);
}

const Variable *variable_of(const Instance *instance, fmi2ValueReference reference, Type type)
{
    if (reference >= variable_count) {
        refuse(
            instance, "value reference %u is unknown; %s has 0 to %u", reference, model_name, variable_count - 1);
        return NULL;
    }
    const Variable *variable = &variables[reference];
    if (variable->type == type)
        return variable;
    refuse(instance, "%s is of type %s, not %s", variable->name, type_names[variable->type], type_names[type]);
    return NULL;
}

/* Before the end of initialization mode the outputs are those of the state that would be started from. */
static void compute_outputs(Memory *memory)
{
    const Values *values = &memory->values;
    State x;
    if (memory->mode & (INSTANTIATED | INITIALIZATION))
        start(&values->u, &values->p, &x);
    else
        x = memory->x;
    output(&x, &values->u, &values->p, &memory->values.y);
    memory->outputs_known = 1;
}

static int has_arrays(
    const Instance *instance, Type type, const fmi2ValueReference references[], size_t count, const void *values)
{
    if (count == 0 || (references && values))
        return 1;
    refuse(instance, "%u values of type %s, but an array is NULL", (unsigned)count, type_names[type]);
    return 0;
}

fmi2Status get_values(Instance *instance, Type type, const fmi2ValueReference references[], size_t count, void *values)
{
    Memory *memory = &instance->memory;
    if (!has_arrays(instance, type, references, count, values))
        return fmi2Error;
    for (size_t k = 0; k < count; k++) {
        const Variable *variable = variable_of(instance, references[k], type);
        if (!variable)
            return fmi2Error;
        if (variable->causality == OUTPUT && !memory->outputs_known)
            compute_outputs(memory);
    }
    for (size_t k = 0; k < count; k++) {
        const double value = *place_of(&memory->values, &variables[references[k]]);
        if (type == REAL)
            ((fmi2Real *)values)[k] = value;
        else
            ((fmi2Integer *)values)[k] = (fmi2Integer)value;
    }
    return fmi2OK;
}

static double value_at(Type type, const void *values, size_t k)
{
    return type == REAL ? ((const fmi2Real *)values)[k] : ((const fmi2Integer *)values)[k];
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

/* Whether a variable can be set to a value now; else it is refused. */
static int is_allowed(const Instance *instance, const Variable *variable, double value)
{
    char text[NUMBER_LENGTH];
    const char *name = variable->name;
    const int64_t mode = instance->memory.mode;
    if (variable->causality == OUTPUT) {
        refuse(instance, "%s is an output and cannot be set", name);
        return 0;
    }
    if (mode == TERMINATED || (mode == STEPPING && variable->causality == PARAMETER)) {
        refuse(
            instance,
            "%s = %s is refused; a parameter can be set until initialization mode is left, "
            "an input until fmi2Terminate, and both again after fmi2Reset",
            name,
            write_value(text, variable->type, value));
        return 0;
    }
    if (value >= variable->minimum && value <= variable->maximum)
        return 1;
    if (variable->causality == INPUT && copes_with_bad_input)
        return 1;
    refuse(
        instance,
        "%s = %s%s%s is refused; allowed is %s",
        name,
        write_value(text, variable->type, value),
        *variable->unit ? " " : "",
        variable->unit,
        variable->allowed);
    return 0;
}

fmi2Status set_values(
    Instance *instance, Type type, const fmi2ValueReference references[], size_t count, const void *values)
{
    Memory *memory = &instance->memory;
    if (!has_arrays(instance, type, references, count, values))
        return fmi2Error;
    for (size_t k = 0; k < count; k++) {
        const Variable *variable = variable_of(instance, references[k], type);
        if (!variable || !is_allowed(instance, variable, value_at(type, values, k)))
            return fmi2Error;
    }
    for (size_t k = 0; k < count; k++) {
        const Variable *variable = &variables[references[k]];
        const double value = value_at(type, values, k);
        *place_of(&memory->values, variable) = type == BOOLEAN ? value != 0.0 : value;
        if (variable->causality == INPUT && memory->moving)
            *(double *)(void *)((char *)&memory->du + (variable->offset - offsetof(Values, u))) = 0.0;
    }
    memory->outputs_known = 0;
    return fmi2OK;
}

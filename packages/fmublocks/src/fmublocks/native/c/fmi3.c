/* The adapter to FMI 3.0: what co-simulation and model exchange share, and co-simulation. fmi3_refused.c has the
functions that it does not offer.

FMI 3.0 has no function that lets an input move during a step. Here the rate of change of an input is a variable, an
input itself. Value references are those of FMI 2.0; behind them are those of the event indicators, then that of the
time, then those of the rates of change of the inputs, in the order of these. */
#include "fmi3Functions.h"
#include "instance.h"
#ifndef SAMPLE_TIME
#include "explicit.h"
#include "model_exchange.h"
#endif

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const type_names[] = {"Float64", "Int32", "Boolean", "String", "Enumeration"};

const char *fmi3GetVersion(void)
{
    return fmi3Version;
}

static fmi3Status in_fmi3(Status status)
{
    return status == OK ? fmi3OK : status == DISCARD ? fmi3Discard : fmi3Error;
}

/* The input whose rate of change a value reference stands for; NULL if there is none. */
static const Variable *moving_input(Reference reference)
{
    if (reference <= reference_count || reference > last_reference)
        return NULL;
    const Variable *input = &variables[reference - reference_count - 1];
    return input->type == REAL ? input : NULL;
}

static int own_name(char name[NAME_LENGTH], Reference reference)
{
    const Variable *input = moving_input(reference);
    if (!input && reference != reference_count)
        return 0;
    if (input)
        snprintf(name, NAME_LENGTH, "der(%s)", input->name);
    else
        strcpy(name, "time");
    return 1;
}

fmi3Status fmi3EnterInitializationMode(
    fmi3Instance c, fmi3Boolean toleranceDefined, fmi3Float64 tolerance, fmi3Float64 startTime,
    fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    (void)toleranceDefined; /* the integration has its own, see integrator.c */
    (void)tolerance;
    Instance *instance = ready(c, INSTANTIATED, 1, __func__);
    if (!instance)
        return fmi3Error;
    const Status status = set_experiment(instance, startTime, stopTimeDefined ? stopTime : (double)INFINITY);
    if (status == OK)
        instance->memory.mode = INITIALIZATION;
    return in_fmi3(status);
}

/* A function without arguments that is allowed in some modes and cannot fail. */
#define CHANGE(function, modes, change)                   \
    fmi3Status function(fmi3Instance c)                   \
    {                                                     \
        Instance *instance = ready(c, modes, 1, __func__); \
        if (!instance)                                    \
            return fmi3Error;                             \
        change;                                           \
        return fmi3OK;                                    \
    }

CHANGE(fmi3ExitInitializationMode, INITIALIZATION, leave_initialization(instance))
CHANGE(fmi3Terminate, RUNNING, instance->memory.mode = TERMINATED)
CHANGE(fmi3Reset, ANY_MODE, renew(instance))

static Status get_Float64(Instance *instance, Reference reference, double *value)
{
    const Variable *input = moving_input(reference);
    if (!input && reference != reference_count)
        return get_values(instance, REAL, &reference, 1, value);
    *value = input ? *rate_of(&instance->memory.du, input) : instance->memory.time;
    return OK;
}

#ifndef SAMPLE_TIME
/* While the host integrates a state can be set as a variable too. */
static int is_settable_state(const Instance *instance, Reference reference)
{
    return reference < reference_count && variables[reference].causality == STATE
           && instance->kind == MODEL_EXCHANGE && (instance->memory.mode & INTEGRATING) != 0;
}

static Status set_state_variable(Instance *instance, Reference reference, double value)
{
    Vector x;
    get_states(instance, x, STATES);
    x[reference - variable_count] = value;
    return set_states(instance, x, STATES);
}
#endif

static Status set_Float64(Instance *instance, Reference reference, double value)
{
    const Variable *input = moving_input(reference);
    if (reference == reference_count)
        return refuse(instance, "time is the independent variable and cannot be set");
#ifndef SAMPLE_TIME
    if (is_settable_state(instance, reference))
        return set_state_variable(instance, reference, value);
#endif
    if (!input)
        return set_values(instance, REAL, &reference, 1, &value);
    if (instance->memory.mode == TERMINATED) {
        char name[NAME_LENGTH], text[NUMBER_LENGTH];
        own_name(name, reference);
        return refuse(instance, SET_TOO_LATE(name, write_number(text, value)));
    }
    reference = (Reference)(input - variables);
    return set_input_rates(instance, &reference, 1, &value);
}

/* Get and set a variable whose values are whole numbers, as the core has them. */
#define WHOLE(Type, TYPE)                                                                     \
    static Status get_##Type(Instance *instance, Reference reference, fmi3##Type *value)      \
    {                                                                                         \
        int whole = 0;                                                                        \
        const Status status = get_values(instance, TYPE, &reference, 1, &whole);              \
        *value = (fmi3##Type)whole;                                                           \
        return status;                                                                        \
    }                                                                                         \
    static Status set_##Type(Instance *instance, Reference reference, fmi3##Type value)       \
    {                                                                                         \
        const int64_t wide = value;                                                           \
        const int whole = (int)(wide > INT_MAX ? INT_MAX : wide < INT_MIN ? INT_MIN : wide);  \
        return set_values(instance, TYPE, &reference, 1, &whole);                             \
    }

WHOLE(Int32, INTEGER)
WHOLE(Int64, ENUMERATION)
WHOLE(Boolean, BOOLEAN)

static int is_count(const Instance *instance, size_t given, size_t expected, const char *function)
{
    if (given != expected)
        refuse(
            instance, "%s: %lu values are refused; allowed is one for each of the %lu value references", function,
            (unsigned long)given, (unsigned long)expected);
    return given == expected;
}

/* Whether value references are those of variables of the block. */
static int are_of_block(const Reference references[], size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (references[k] >= variable_count)
            return 0;
    return 1;
}

/* Of the variables that are set, all are or none. The core takes them at once, if it has them as the host has. */
#define VALUES(Type, TYPE, as_in_core)                                                                               \
    fmi3Status fmi3Get##Type(                                                                                        \
        fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, fmi3##Type values[], size_t nValues)              \
    {                                                                                                                \
        Instance *instance = ready(c, ANY_MODE, nvr == 0 || (vr && values), __func__);                               \
        if (!instance || !is_count(instance, nValues, nvr, __func__))                                                \
            return fmi3Error;                                                                                        \
        if (as_in_core)                                                                                              \
            return in_fmi3(get_values(instance, TYPE, vr, nvr, values));                                             \
        for (size_t k = 0; k < nvr; k++) {                                                                           \
            const Status status = get_##Type(instance, vr[k], &values[k]);                                           \
            if (status != OK)                                                                                        \
                return in_fmi3(status);                                                                              \
        }                                                                                                            \
        return fmi3OK;                                                                                               \
    }                                                                                                                \
    fmi3Status fmi3Set##Type(                                                                                        \
        fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const fmi3##Type values[], size_t nValues)        \
    {                                                                                                                \
        Instance *instance = ready(c, ANY_MODE, nvr == 0 || (vr && values), __func__);                               \
        if (!instance || !is_count(instance, nValues, nvr, __func__))                                                \
            return fmi3Error;                                                                                        \
        if (as_in_core)                                                                                              \
            return in_fmi3(set_values(instance, TYPE, vr, nvr, values));                                             \
        take_over_written(instance);                                                                                 \
        const Memory before = instance->memory;                                                                      \
        for (size_t k = 0; k < nvr; k++) {                                                                           \
            const Status status = set_##Type(instance, vr[k], values[k]);                                            \
            if (status != OK) {                                                                                      \
                instance->memory = before;                                                                           \
                know_parameters(instance);                                                                           \
                return in_fmi3(status);                                                                              \
            }                                                                                                        \
        }                                                                                                            \
        return fmi3OK;                                                                                               \
    }

VALUES(Float64, REAL, are_of_block(vr, nvr))
VALUES(Int32, INTEGER, 1)
VALUES(Int64, ENUMERATION, 0)
VALUES(Boolean, BOOLEAN, 0)

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *FMUState)
{
    Instance *instance = ready(c, ANY_MODE, FMUState != NULL, __func__);
    return instance ? in_fmi3(get_state(instance, FMUState)) : fmi3Error;
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState FMUState)
{
    Instance *instance = ready(c, ANY_MODE, FMUState != NULL, __func__);
    return instance ? in_fmi3(set_state(instance, FMUState)) : fmi3Error;
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *FMUState)
{
    if (!c)
        return fmi3Error;
    if (FMUState) {
        free(*FMUState);
        *FMUState = NULL;
    }
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState FMUState, size_t *size)
{
    if (!ready(c, ANY_MODE, FMUState && size, __func__))
        return fmi3Error;
    *size = serialized_size();
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState FMUState, fmi3Byte serializedState[], size_t size)
{
    const Instance *instance = ready(c, ANY_MODE, FMUState && serializedState, __func__);
    return instance ? in_fmi3(serialize_state(instance, FMUState, serializedState, size)) : fmi3Error;
}

fmi3Status fmi3DeserializeFMUState(
    fmi3Instance c, const fmi3Byte serializedState[], size_t size, fmi3FMUState *FMUState)
{
    const Instance *instance = ready(c, ANY_MODE, FMUState && serializedState, __func__);
    return instance ? in_fmi3(deserialize_state(instance, serializedState, size, FMUState)) : fmi3Error;
}

fmi3Status fmi3GetDirectionalDerivative(
    fmi3Instance c, const fmi3ValueReference unknowns[], size_t nUnknowns, const fmi3ValueReference knowns[],
    size_t nKnowns, const fmi3Float64 seed[], size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity)
{
    const int complete = (nUnknowns == 0 || (unknowns && sensitivity)) && (nKnowns == 0 || (knowns && seed));
    const Instance *instance = ready(c, INITIALIZATION | RUNNING | TERMINATED, complete, __func__);
    if (!instance || !is_count(instance, nSeed, nKnowns, __func__) ||
        !is_count(instance, nSensitivity, nUnknowns, __func__))
        return fmi3Error;
    const Direction direction = {unknowns, nUnknowns, knowns, nKnowns, seed};
    return in_fmi3(get_directional_derivative(instance, &direction, sensitivity));
}

fmi3Status fmi3GetOutputDerivatives(
    fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const fmi3Int32 orders[], fmi3Float64 values[],
    size_t nValues)
{
    const int complete = nvr == 0 || (vr && orders && values);
    const Instance *instance = ready_for(CO_SIMULATION, c, STEPPING | TERMINATED, complete, __func__);
    if (!instance || !is_count(instance, nValues, nvr, __func__) || !orders_are_one(instance, orders, nvr))
        return fmi3Error;
    return in_fmi3(get_output_rates(instance, vr, nvr, values));
}

fmi3Status fmi3DoStep(
    fmi3Instance c, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
    fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminateSimulation,
    fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    const int complete = eventHandlingNeeded && terminateSimulation && earlyReturn && lastSuccessfulTime;
    Instance *instance = ready_for(CO_SIMULATION, c, STEPPING, complete, __func__);
    if (!instance)
        return fmi3Error;
#ifdef TERMINAL
    const Status status = step_and_send(instance, currentCommunicationPoint, communicationStepSize);
    *eventHandlingNeeded = instance->has_events && instance->memory.terminal.tx_size > 0;
#else
    const Status status = make_step(instance, currentCommunicationPoint, communicationStepSize);
    *eventHandlingNeeded = fmi3False;
#endif
    *terminateSimulation = *earlyReturn = fmi3False;
    *lastSuccessfulTime = instance->memory.time;
    return in_fmi3(status);
}

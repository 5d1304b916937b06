/* The adapter to FMI 3.0 for co-simulation; fmi3_refused.c has the functions that it does not offer.

FMI 3.0 has no function that lets an input move during a step. Here the rate of change of an input is a variable, an
input itself. Value references are those of FMI 2.0; behind them is that of the time, then those of the rates of change
of the inputs, in the order of these. */
#include "fmi3Functions.h"
#include "instance.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An instance as the host has it. */
typedef struct {
    Instance instance;
    fmi3LogMessageCallback log_message;
    fmi3InstanceEnvironment environment;
} Component;

static const char *const type_names[] = {"Float64", "Int32", "Boolean", "String", "Enumeration"};

const char *fmi3GetVersion(void)
{
    return fmi3Version;
}

static fmi3Status in_fmi3(Status status)
{
    return status == OK ? fmi3OK : status == DISCARD ? fmi3Discard : fmi3Error;
}

static void log_for(void *listener, Status status, const char *message)
{
    const Component *component = listener;
    if (component->log_message)
        component->log_message(component->environment, in_fmi3(status), category_of(status), message);
}

fmi3Status fmi3SetDebugLogging(
    fmi3Instance c, fmi3Boolean loggingOn, size_t nCategories, const fmi3String categories[])
{
    Instance *instance = ready(c, ANY_MODE, nCategories == 0 || categories, __func__);
    return instance ? in_fmi3(set_logging(instance, loggingOn, nCategories, categories)) : fmi3Error;
}

/* The input whose rate of change a value reference stands for; NULL if there is none. */
static const Variable *moving_input(Reference reference)
{
    if (reference <= variable_count || reference > last_reference)
        return NULL;
    const Variable *input = &variables[reference - variable_count - 1];
    return input->type == REAL ? input : NULL;
}

static int own_name(char name[NAME_LENGTH], Reference reference)
{
    const Variable *input = moving_input(reference);
    if (!input && reference != variable_count)
        return 0;
    if (input)
        snprintf(name, NAME_LENGTH, "der(%s)", input->name);
    else
        strcpy(name, "time");
    return 1;
}

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String instanceName,
    fmi3String instantiationToken,
    fmi3String resourcePath,
    fmi3Boolean visible,
    fmi3Boolean loggingOn,
    fmi3Boolean eventModeUsed,
    fmi3Boolean earlyReturnAllowed,
    const fmi3ValueReference requiredIntermediateVariables[],
    size_t nRequiredIntermediateVariables,
    fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage,
    fmi3IntermediateUpdateCallback intermediateUpdate)
{
    (void)resourcePath;
    (void)visible;
    (void)earlyReturnAllowed; /* no step ends early */
    (void)requiredIntermediateVariables;
    (void)intermediateUpdate;
    Component *component = NULL;
    const char *why = NULL;
    if (!instanceName || !*instanceName)
        why = "fmi3InstantiateCoSimulation: an instance needs a name";
    else if (!instantiationToken || strcmp(instantiationToken, model_guid) != 0)
        why = "fmi3InstantiateCoSimulation: the instantiation token is that of another FMU";
    else if (eventModeUsed && !allows_event_mode)
        why = "fmi3InstantiateCoSimulation: the FMU has no event mode";
    else if (nRequiredIntermediateVariables)
        why = "fmi3InstantiateCoSimulation: the FMU has no intermediate update";
    else if (!(component = first_place(sizeof *component)) && !(component = calloc(1, sizeof *component)))
        why = "fmi3InstantiateCoSimulation: no memory";
    if (why && logMessage)
        logMessage(instanceEnvironment, fmi3Error, category_of(ERROR), why);
    if (why)
        return NULL;
    const Host host = {calloc, log_for, component, own_name, {0}};
    component->instance.host = host;
    component->instance.has_events = eventModeUsed;
    component->log_message = logMessage;
    component->environment = instanceEnvironment;
    set_logging(&component->instance, loggingOn, 0, NULL);
    renew(&component->instance);
    return component;
}

void fmi3FreeInstance(fmi3Instance c)
{
    if (!left_first_place(c))
        free(c);
}

fmi3Status fmi3EnterInitializationMode(
    fmi3Instance c,
    fmi3Boolean toleranceDefined,
    fmi3Float64 tolerance,
    fmi3Float64 startTime,
    fmi3Boolean stopTimeDefined,
    fmi3Float64 stopTime)
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
    if (!input && reference != variable_count)
        return get_values(instance, REAL, &reference, 1, value);
    *value = input ? *rate_of(&instance->memory.du, input) : instance->memory.time;
    return OK;
}

static Status set_Float64(Instance *instance, Reference reference, double value)
{
    const Variable *input = moving_input(reference);
    if (reference == variable_count)
        return refuse(instance, "time is the independent variable and cannot be set");
    if (!input)
        return set_values(instance, REAL, &reference, 1, &value);
    if (instance->memory.mode == TERMINATED) {
        char name[NAME_LENGTH], text[NUMBER_LENGTH];
        own_name(name, reference);
        return refuse(instance, SET_TOO_LATE(name, write_number(text, value)));
    }
    reference = (Reference)(input - variables);
    const unsigned modes = INSTANTIATED | INITIALIZATION | STEPPING;
    return in_mode(instance, modes, "fmi3SetFloat64") ? set_input_rates(instance, &reference, 1, &value) : ERROR;
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
            instance,
            "%s: %lu values are refused; allowed is one for each of the %lu value references",
            function,
            (unsigned long)given,
            (unsigned long)expected);
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
        for (size_t k = 0; k < nvr; k++)                                                                             \
            if (get_##Type(instance, vr[k], &values[k]) != OK)                                                       \
                return fmi3Error;                                                                                    \
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
        const Memory before = instance->memory;                                                                      \
        for (size_t k = 0; k < nvr; k++)                                                                             \
            if (set_##Type(instance, vr[k], values[k]) != OK) {                                                      \
                instance->memory = before;                                                                           \
                return fmi3Error;                                                                                    \
            }                                                                                                        \
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
    fmi3Instance c,
    const fmi3ValueReference unknowns[],
    size_t nUnknowns,
    const fmi3ValueReference knowns[],
    size_t nKnowns,
    const fmi3Float64 seed[],
    size_t nSeed,
    fmi3Float64 sensitivity[],
    size_t nSensitivity)
{
    const int complete = (nUnknowns == 0 || (unknowns && sensitivity)) && (nKnowns == 0 || (knowns && seed));
    const Instance *instance = ready(c, INITIALIZATION | STEPPING | TERMINATED, complete, __func__);
    if (!instance || !is_count(instance, nSeed, nKnowns, __func__) ||
        !is_count(instance, nSensitivity, nUnknowns, __func__))
        return fmi3Error;
    const Direction direction = {unknowns, nUnknowns, knowns, nKnowns, seed};
    return in_fmi3(get_directional_derivative(instance, &direction, sensitivity));
}

fmi3Status fmi3GetOutputDerivatives(
    fmi3Instance c,
    const fmi3ValueReference vr[],
    size_t nvr,
    const fmi3Int32 orders[],
    fmi3Float64 values[],
    size_t nValues)
{
    const Instance *instance = ready(c, STEPPING | TERMINATED, nvr == 0 || (vr && orders && values), __func__);
    if (!instance || !is_count(instance, nValues, nvr, __func__) || !orders_are_one(instance, orders, nvr))
        return fmi3Error;
    return in_fmi3(get_output_rates(instance, vr, nvr, values));
}

fmi3Status fmi3DoStep(
    fmi3Instance c,
    fmi3Float64 currentCommunicationPoint,
    fmi3Float64 communicationStepSize,
    fmi3Boolean noSetFMUStatePriorToCurrentPoint,
    fmi3Boolean *eventHandlingNeeded,
    fmi3Boolean *terminateSimulation,
    fmi3Boolean *earlyReturn,
    fmi3Float64 *lastSuccessfulTime)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    const int complete = eventHandlingNeeded && terminateSimulation && earlyReturn && lastSuccessfulTime;
    Instance *instance = ready(c, STEPPING, complete, __func__);
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

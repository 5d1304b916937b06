/* The adapter to FMI 2.0: what co-simulation and model exchange share, and co-simulation. It keeps the callbacks of the
host and sees to it that calls come in an order that makes sense; what they do is done by the instance. */
#include "fmi2_adapter.h"

#include <math.h>
#include <string.h>

/* An instance as the host has it. */
typedef struct {
    Instance instance;
    fmi2CallbackFunctions callbacks;
    char name[];
} Component;

static const char *const type_names[] = {"Real", "Integer", "Boolean", "String", "Integer"};

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return fmi2Version;
}

fmi2Status in_fmi(Status status)
{
    return status == OK ? fmi2OK : status == DISCARD ? fmi2Discard : fmi2Error;
}

/* Calls the logger, which takes the message for a format. */
static void say(const fmi2CallbackFunctions *callbacks, fmi2String name, Status status, const char *message)
{
    char escaped[2 * MESSAGE_LENGTH], *at = escaped;
    if (!callbacks->logger)
        return;
    for (; *message; *at++ = *message++)
        if (*message == '%')
            *at++ = '%';
    *at = '\0';
    callbacks->logger(callbacks->componentEnvironment, name, in_fmi(status), category_of(status), escaped);
}

static void log_for(void *listener, Status status, const char *message)
{
    const Component *component = listener;
    say(&component->callbacks, component->name, status, message);
}

fmi2Status fmi2SetDebugLogging(
    fmi2Component c, fmi2Boolean loggingOn, size_t nCategories, const fmi2String categories[])
{
    Instance *instance = ready(c, ANY_MODE, nCategories == 0 || categories, __func__);
    return instance ? in_fmi(set_logging(instance, loggingOn, nCategories, categories)) : fmi2Error;
}

/* Why there cannot be such an instance; NULL if there can. */
static const char *objection(fmi2String name, fmi2Type type, fmi2String guid, const fmi2CallbackFunctions *callbacks)
{
    if (!name || !*name)
        return "fmi2Instantiate: an instance needs a name";
    if (type != fmi2CoSimulation && !(type == fmi2ModelExchange && allows_model_exchange))
        return "fmi2Instantiate: the FMU is for co-simulation";
    if (!guid || strcmp(guid, model_guid) != 0)
        return "fmi2Instantiate: the GUID is that of another FMU";
    if (!callbacks->allocateMemory || !callbacks->freeMemory)
        return "fmi2Instantiate: the callbacks for memory are missing";
    return NULL;
}

fmi2Component fmi2Instantiate(
    fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID, fmi2String fmuResourceLocation,
    const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean loggingOn)
{
    (void)fmuResourceLocation;
    (void)visible;
    if (!functions)
        return NULL;
    const char *why = objection(instanceName, fmuType, fmuGUID, functions);
    const size_t size = offsetof(Component, name) + (why ? 0 : strlen(instanceName) + 1);
    Component *component = why ? NULL : first_place(size);
    if (!why && !component)
        component = functions->allocateMemory(1, size);
    if (!component) {
        say(functions, instanceName ? instanceName : "", ERROR, why ? why : "fmi2Instantiate: no memory");
        return NULL;
    }
    const Host host = {functions->allocateMemory, log_for, component, NULL, {0}};
    component->instance.host = host;
    component->instance.kind = fmuType == fmi2ModelExchange ? MODEL_EXCHANGE : CO_SIMULATION;
    component->callbacks = *functions;
    set_logging(&component->instance, loggingOn, 0, NULL);
    strcpy(component->name, instanceName);
    renew(&component->instance);
    return component;
}

void fmi2FreeInstance(fmi2Component c)
{
    Component *component = c;
    if (component && !left_first_place(component))
        component->callbacks.freeMemory(component);
}

fmi2Status fmi2SetupExperiment(
    fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance, fmi2Real startTime,
    fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    (void)toleranceDefined; /* the integration has its own, see integrator.c; in model exchange it is the host's */
    (void)tolerance;
    const double stop = stopTimeDefined ? stopTime : (double)INFINITY;
    Instance *instance = ready(c, INSTANTIATED, 1, __func__);
    return instance ? in_fmi(set_experiment(instance, startTime, stop)) : fmi2Error;
}

/* A function without arguments that is allowed in some modes and cannot fail. */
#define CHANGE(function, modes, change)                   \
    fmi2Status function(fmi2Component c)                  \
    {                                                     \
        Instance *instance = ready(c, modes, 1, __func__); \
        if (!instance)                                    \
            return fmi2Error;                             \
        change;                                           \
        return fmi2OK;                                    \
    }

CHANGE(fmi2EnterInitializationMode, INSTANTIATED, instance->memory.mode = INITIALIZATION)
CHANGE(fmi2ExitInitializationMode, INITIALIZATION, leave_initialization(instance))
CHANGE(fmi2Terminate, RUNNING, instance->memory.mode = TERMINATED)
CHANGE(fmi2Reset, ANY_MODE, renew(instance))

/* FMI 2.0 lets an input move for one step, and holds it from when it is set. */
static Status set_held(Instance *instance, Type type, const Reference references[], size_t count, const void *values)
{
    if (!moving(&instance->memory))
        return set_values(instance, type, references, count, values);
    const Status status = set_values(instance, type, references, count, values);
    for (size_t k = 0; status == OK && k < count; k++)
        if (variables[references[k]].causality == INPUT)
            *rate_of(&instance->memory.du, &variables[references[k]]) = 0.0;
    return status;
}

#define VALUES(Type, TYPE)                                                                                             \
    fmi2Status fmi2Get##Type(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2##Type value[])           \
    {                                                                                                                  \
        Instance *instance = ready(c, ANY_MODE, 1, __func__);                                                          \
        return instance ? in_fmi(get_values(instance, TYPE, vr, nvr, value)) : fmi2Error;                              \
    }                                                                                                                  \
    fmi2Status fmi2Set##Type(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2##Type value[])     \
    {                                                                                                                  \
        Instance *instance = ready(c, ANY_MODE, 1, __func__);                                                          \
        return instance ? in_fmi(set_held(instance, TYPE, vr, nvr, value)) : fmi2Error;                                \
    }

VALUES(Real, REAL)
VALUES(Integer, INTEGER)
VALUES(Boolean, BOOLEAN)
VALUES(String, STRING)

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    Instance *instance = ready(c, ANY_MODE, FMUstate != NULL, __func__);
    return instance ? in_fmi(get_state(instance, FMUstate)) : fmi2Error;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate)
{
    Instance *instance = ready(c, ANY_MODE, FMUstate != NULL, __func__);
    return instance ? in_fmi(set_state(instance, FMUstate)) : fmi2Error;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    const Component *component = c;
    if (!component)
        return fmi2Error;
    if (FMUstate && *FMUstate) {
        component->callbacks.freeMemory(*FMUstate);
        *FMUstate = NULL;
    }
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t *size)
{
    if (!ready(c, ANY_MODE, FMUstate && size, __func__))
        return fmi2Error;
    *size = serialized_size();
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[], size_t size)
{
    const Instance *instance = ready(c, ANY_MODE, FMUstate && serializedState, __func__);
    return instance ? in_fmi(serialize_state(instance, FMUstate, serializedState, size)) : fmi2Error;
}

fmi2Status fmi2DeSerializeFMUstate(
    fmi2Component c, const fmi2Byte serializedState[], size_t size, fmi2FMUstate *FMUstate)
{
    const Instance *instance = ready(c, ANY_MODE, FMUstate && serializedState, __func__);
    return instance ? in_fmi(deserialize_state(instance, serializedState, size, FMUstate)) : fmi2Error;
}

fmi2Status fmi2GetDirectionalDerivative(
    fmi2Component c, const fmi2ValueReference vUnknown_ref[], size_t nUnknown, const fmi2ValueReference vKnown_ref[],
    size_t nKnown, const fmi2Real dvKnown[], fmi2Real dvUnknown[])
{
    const int complete = (nUnknown == 0 || (vUnknown_ref && dvUnknown)) && (nKnown == 0 || (vKnown_ref && dvKnown));
    const Instance *instance = ready(c, INITIALIZATION | RUNNING | TERMINATED, complete, __func__);
    if (!instance)
        return fmi2Error;
    const Direction direction = {vUnknown_ref, nUnknown, vKnown_ref, nKnown, dvKnown};
    return in_fmi(get_directional_derivative(instance, &direction, dvUnknown));
}

fmi2Status fmi2SetRealInputDerivatives(
    fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Integer order[], const fmi2Real value[])
{
    const int complete = nvr == 0 || (vr && order && value);
    Instance *instance = ready_for(CO_SIMULATION, c, INSTANTIATED | INITIALIZATION | STEPPING, complete, __func__);
    const int allowed = instance && orders_are_one(instance, order, nvr);
    return allowed ? in_fmi(set_input_rates(instance, vr, nvr, value)) : fmi2Error;
}

fmi2Status fmi2GetRealOutputDerivatives(
    fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Integer order[], fmi2Real value[])
{
    const int complete = nvr == 0 || (vr && order && value);
    const Instance *instance = ready_for(CO_SIMULATION, c, STEPPING | TERMINATED, complete, __func__);
    const int allowed = instance && orders_are_one(instance, order, nvr);
    return allowed ? in_fmi(get_output_rates(instance, vr, nvr, value)) : fmi2Error;
}

fmi2Status fmi2DoStep(
    fmi2Component c, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
    fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    static const Input held;
    Instance *instance = ready_for(CO_SIMULATION, c, STEPPING, 1, __func__);
    if (!instance)
        return fmi2Error;
    const Status status = make_step(instance, currentCommunicationPoint, communicationStepSize);
    if (status == OK)
        instance->memory.du = held;
    return in_fmi(status);
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    const Instance *instance = ready_for(CO_SIMULATION, c, ANY_MODE, 1, __func__);
    if (instance)
        refuse(instance, "fmi2CancelStep is refused; every step ends before fmi2DoStep returns");
    return fmi2Error;
}

/* A function that answers one kind of question about the status and discards the others. */
#define ANSWER(function, Type, known, answer)                                                                          \
    fmi2Status function(fmi2Component c, const fmi2StatusKind s, Type *value)                                          \
    {                                                                                                                  \
        const Instance *instance = ready_for(CO_SIMULATION, c, STEPPING | TERMINATED, value != NULL, __func__);        \
        if (!instance)                                                                                                 \
            return fmi2Error;                                                                                          \
        if (!(known))                                                                                                  \
            return in_fmi(discard(instance, "%s has no answer for the kind %d of status", __func__, (int)s));          \
        *value = answer;                                                                                               \
        return fmi2OK;                                                                                                 \
    }

ANSWER(fmi2GetStatus, fmi2Status, s == fmi2DoStepStatus, in_fmi((Status)instance->memory.last_step))
ANSWER(fmi2GetRealStatus, fmi2Real, s == fmi2LastSuccessfulTime, instance->memory.time)
ANSWER(fmi2GetIntegerStatus, fmi2Integer, 0, 0)
ANSWER(fmi2GetBooleanStatus, fmi2Boolean, s == fmi2Terminated, fmi2False) /* the FMU never asks for the end of a run */
ANSWER(fmi2GetStringStatus, fmi2String, s == fmi2PendingStatus, "")       /* nothing is ever pending */

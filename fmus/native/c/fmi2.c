/* The functions of FMI 2.0 for co-simulation, which see to it that calls come in an order that makes sense. */
#include "instance.h"
#include "state.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* In s: how far the host's time may be from the FMU's. */
#define TIME_TOLERANCE 1e-6

/* In s: a longer communication step is a mistake of the host, and would keep it waiting for ever. */
#define LONGEST_COMMUNICATION_STEP 1000.0

enum { ANY_MODE = INSTANTIATED | INITIALIZATION | STEPPING | TERMINATED };

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return fmi2Version;
}

/* The instance, if there is one and it is in one of the modes; else NULL. */
static Instance *ready(fmi2Component component, unsigned modes, const char *function)
{
    Instance *instance = component;
    return instance && in_mode(instance, modes, function) ? instance : NULL;
}

static fmi2Status refuse_null(const Instance *instance, const char *function)
{
    return refuse(instance, "%s: an argument is NULL", function);
}

/* ---- creation and destruction ---- */

static void make_new(Memory *memory)
{
    memset(memory, 0, sizeof *memory);
    set_start_values(memory);
    memory->mode = INSTANTIATED;
}

/* Why an FMU cannot be instantiated so; NULL if it can. */
static const char *objection(fmi2String name, fmi2Type type, fmi2String guid, const fmi2CallbackFunctions *callbacks)
{
    if (!name || !*name)
        return "fmi2Instantiate: an instance needs a name";
    if (type != fmi2CoSimulation)
        return "fmi2Instantiate: the FMU is for co-simulation";
    if (!guid || strcmp(guid, model_guid) != 0)
        return "fmi2Instantiate: the GUID is that of another FMU";
    if (!callbacks->allocateMemory || !callbacks->freeMemory)
        return "fmi2Instantiate: the callbacks for memory are missing";
    return NULL;
}

fmi2Component fmi2Instantiate(
    fmi2String instanceName,
    fmi2Type fmuType,
    fmi2String fmuGUID,
    fmi2String fmuResourceLocation,
    const fmi2CallbackFunctions *functions,
    fmi2Boolean visible,
    fmi2Boolean loggingOn)
{
    (void)fmuResourceLocation;
    (void)visible;
    if (!functions)
        return NULL;
    const char *why = objection(instanceName, fmuType, fmuGUID, functions);
    if (why) {
        log_without_instance(functions, instanceName, why);
        return NULL;
    }
    Instance *instance = functions->allocateMemory(1, sizeof *instance);
    char *name = functions->allocateMemory(strlen(instanceName) + 1, 1);
    if (!instance || !name) {
        if (instance)
            functions->freeMemory(instance);
        if (name)
            functions->freeMemory(name);
        log_without_instance(functions, instanceName, "fmi2Instantiate: no memory");
        return NULL;
    }
    instance->callbacks = *functions;
    instance->name = strcpy(name, instanceName);
    for (int k = 0; k < LOG_CATEGORIES; k++)
        instance->logged[k] = loggingOn;
    make_new(&instance->memory);
    return instance;
}

void fmi2FreeInstance(fmi2Component c)
{
    Instance *instance = c;
    if (!instance)
        return;
    const fmi2CallbackFreeMemory free_memory = instance->callbacks.freeMemory;
    free_memory(instance->name);
    free_memory(instance);
}

fmi2Status fmi2SetDebugLogging(
    fmi2Component c, fmi2Boolean loggingOn, size_t nCategories, const fmi2String categories[])
{
    Instance *instance = ready(c, ANY_MODE, "fmi2SetDebugLogging");
    if (!instance)
        return fmi2Error;
    if (nCategories > 0 && !categories)
        return refuse_null(instance, "fmi2SetDebugLogging");
    for (size_t k = 0; k < nCategories; k++)
        if (category_of(categories[k]) < 0)
            return refuse(
                instance,
                "log category %s is unknown; there are logStatusError and logStatusDiscard",
                categories[k] ? categories[k] : "NULL");
    for (int k = 0; k < LOG_CATEGORIES && nCategories == 0; k++)
        instance->logged[k] = loggingOn;
    for (size_t k = 0; k < nCategories; k++)
        instance->logged[category_of(categories[k])] = loggingOn;
    return fmi2OK;
}

/* ---- initialization, end, beginning again ---- */

fmi2Status fmi2SetupExperiment(
    fmi2Component c,
    fmi2Boolean toleranceDefined,
    fmi2Real tolerance,
    fmi2Real startTime,
    fmi2Boolean stopTimeDefined,
    fmi2Real stopTime)
{
    (void)toleranceDefined; /* the integration is exact to rounding whatever is asked for */
    (void)tolerance;
    (void)stopTimeDefined;
    (void)stopTime;
    Instance *instance = ready(c, INSTANTIATED, "fmi2SetupExperiment");
    char text[NUMBER_LENGTH];
    if (!instance)
        return fmi2Error;
    if (!(fabs(startTime) <= DBL_MAX))
        return refuse(
            instance, "startTime = %s s is refused; allowed is any finite number", write_number(text, startTime));
    instance->memory.start_time = instance->memory.time = startTime;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    Instance *instance = ready(c, INSTANTIATED, "fmi2EnterInitializationMode");
    if (!instance)
        return fmi2Error;
    instance->memory.mode = INITIALIZATION;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    Instance *instance = ready(c, INITIALIZATION, "fmi2ExitInitializationMode");
    if (!instance)
        return fmi2Error;
    Memory *memory = &instance->memory;
    start(&memory->values.u, &memory->values.p, &memory->x);
    memory->coming = memory->x;
    memory->mode = STEPPING;
    return fmi2OK;
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    Instance *instance = ready(c, STEPPING, "fmi2Terminate");
    if (!instance)
        return fmi2Error;
    instance->memory.mode = TERMINATED;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c)
{
    Instance *instance = ready(c, ANY_MODE, "fmi2Reset");
    if (!instance)
        return fmi2Error;
    make_new(&instance->memory);
    return fmi2OK;
}

/* ---- values ---- */

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[])
{
    return c ? get_values(c, REAL, vr, nvr, value) : fmi2Error;
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Integer value[])
{
    return c ? get_values(c, INTEGER, vr, nvr, value) : fmi2Error;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Boolean value[])
{
    return c ? get_values(c, BOOLEAN, vr, nvr, value) : fmi2Error;
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2String value[])
{
    return c ? get_values(c, STRING, vr, nvr, value) : fmi2Error;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[])
{
    return c ? set_values(c, REAL, vr, nvr, value) : fmi2Error;
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Integer value[])
{
    return c ? set_values(c, INTEGER, vr, nvr, value) : fmi2Error;
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Boolean value[])
{
    return c ? set_values(c, BOOLEAN, vr, nvr, value) : fmi2Error;
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2String value[])
{
    return c ? set_values(c, STRING, vr, nvr, value) : fmi2Error;
}

/* ---- saved states ---- */

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    const Instance *instance = ready(c, ANY_MODE, "fmi2GetFMUstate");
    if (!instance)
        return fmi2Error;
    return FMUstate ? get_state(instance, FMUstate) : refuse_null(instance, "fmi2GetFMUstate");
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate)
{
    Instance *instance = ready(c, ANY_MODE, "fmi2SetFMUstate");
    if (!instance)
        return fmi2Error;
    if (!FMUstate)
        return refuse_null(instance, "fmi2SetFMUstate");
    memcpy(&instance->memory, FMUstate, sizeof instance->memory);
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    const Instance *instance = ready(c, ANY_MODE, "fmi2FreeFMUstate");
    if (!instance)
        return fmi2Error;
    if (FMUstate && *FMUstate) {
        instance->callbacks.freeMemory(*FMUstate);
        *FMUstate = NULL;
    }
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t *size)
{
    const Instance *instance = ready(c, ANY_MODE, "fmi2SerializedFMUstateSize");
    if (!instance)
        return fmi2Error;
    if (!FMUstate || !size)
        return refuse_null(instance, "fmi2SerializedFMUstateSize");
    *size = sizeof(SavedState);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[], size_t size)
{
    const Instance *instance = ready(c, ANY_MODE, "fmi2SerializeFMUstate");
    if (!instance)
        return fmi2Error;
    if (!FMUstate || !serializedState)
        return refuse_null(instance, "fmi2SerializeFMUstate");
    return serialize_state(instance, FMUstate, serializedState, size);
}

fmi2Status fmi2DeSerializeFMUstate(
    fmi2Component c, const fmi2Byte serializedState[], size_t size, fmi2FMUstate *FMUstate)
{
    const Instance *instance = ready(c, ANY_MODE, "fmi2DeSerializeFMUstate");
    if (!instance)
        return fmi2Error;
    if (!FMUstate || !serializedState)
        return refuse_null(instance, "fmi2DeSerializeFMUstate");
    return deserialize_state(instance, serializedState, size, FMUstate);
}

/* ---- rates of change ---- */

fmi2Status fmi2GetDirectionalDerivative(
    fmi2Component c,
    const fmi2ValueReference vUnknown_ref[],
    size_t nUnknown,
    const fmi2ValueReference vKnown_ref[],
    size_t nKnown,
    const fmi2Real dvKnown[],
    fmi2Real dvUnknown[])
{
    const unsigned modes = INITIALIZATION | STEPPING | TERMINATED;
    Instance *instance = ready(c, modes, "fmi2GetDirectionalDerivative");
    if (!instance)
        return fmi2Error;
    if ((nUnknown > 0 && !(vUnknown_ref && dvUnknown)) || (nKnown > 0 && !(vKnown_ref && dvKnown)))
        return refuse_null(instance, "fmi2GetDirectionalDerivative");
    return get_directional_derivative(instance, vUnknown_ref, nUnknown, vKnown_ref, nKnown, dvKnown, dvUnknown);
}

/* Whether all orders of derivatives are 1; else they are refused. */
static int orders_are_one(const Instance *instance, const fmi2Integer order[], size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (order[k] != 1) {
            refuse(instance, "derivative of order %d is refused; allowed is 1", order[k]);
            return 0;
        }
    return 1;
}

fmi2Status fmi2SetRealInputDerivatives(
    fmi2Component c,
    const fmi2ValueReference vr[],
    size_t nvr,
    const fmi2Integer order[],
    const fmi2Real value[])
{
    Instance *instance = ready(c, INSTANTIATED | INITIALIZATION | STEPPING, "fmi2SetRealInputDerivatives");
    if (!instance)
        return fmi2Error;
    if (nvr > 0 && !(vr && order && value))
        return refuse_null(instance, "fmi2SetRealInputDerivatives");
    return orders_are_one(instance, order, nvr) ? set_input_rates(instance, vr, nvr, value) : fmi2Error;
}

fmi2Status fmi2GetRealOutputDerivatives(
    fmi2Component c,
    const fmi2ValueReference vr[],
    size_t nvr,
    const fmi2Integer order[],
    fmi2Real value[])
{
    Instance *instance = ready(c, STEPPING | TERMINATED, "fmi2GetRealOutputDerivatives");
    if (!instance)
        return fmi2Error;
    if (nvr > 0 && !(vr && order && value))
        return refuse_null(instance, "fmi2GetRealOutputDerivatives");
    return orders_are_one(instance, order, nvr) ? get_output_rates(instance, vr, nvr, value) : fmi2Error;
}

/* ---- steps ---- */

static fmi2Status check_step(Instance *instance, double time, double step_size)
{
    char text[NUMBER_LENGTH], reached[NUMBER_LENGTH];
    if (!(step_size > 0.0 && step_size <= LONGEST_COMMUNICATION_STEP))
        return discard(
            instance,
            "communicationStepSize = %s s is refused; allowed is above 0 to 1000 s",
            write_number(text, step_size));
    if (!(fabs(time - instance->memory.time) <= TIME_TOLERANCE))
        return discard(
            instance,
            "currentCommunicationPoint = %s s is refused; %s has been computed up to %s s",
            write_number(text, time),
            model_name,
            write_number(reached, instance->memory.time));
    return check_moving_inputs(instance, step_size);
}

fmi2Status fmi2DoStep(
    fmi2Component c,
    fmi2Real currentCommunicationPoint,
    fmi2Real communicationStepSize,
    fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    Instance *instance = ready(c, STEPPING, "fmi2DoStep");
    if (!instance)
        return fmi2Error;
    Memory *memory = &instance->memory;
    memory->last_step = check_step(instance, currentCommunicationPoint, communicationStepSize);
    if (memory->last_step == fmi2OK) {
        const double end = currentCommunicationPoint + communicationStepSize;
        advance(memory, end, communicationStepSize);
        memory->time = end;
        memory->outputs_known = 0;
    }
    return (fmi2Status)memory->last_step;
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    const Instance *instance = c;
    return instance ? refuse(instance, "fmi2CancelStep is refused; every step ends before fmi2DoStep returns") : fmi2Error;
}

/* ---- status ---- */

/* The instance, if the status can be asked for; the value cannot be stored where `value` is NULL. */
static Instance *asked(fmi2Component c, const void *value, const char *function)
{
    Instance *instance = ready(c, STEPPING | TERMINATED, function);
    if (instance && !value) {
        refuse_null(instance, function);
        return NULL;
    }
    return instance;
}

static fmi2Status discard_kind(const Instance *instance, const char *function, fmi2StatusKind kind)
{
    return discard(instance, "%s has no answer for the kind %d of status", function, (int)kind);
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s, fmi2Status *value)
{
    const Instance *instance = asked(c, value, "fmi2GetStatus");
    if (!instance)
        return fmi2Error;
    if (s != fmi2DoStepStatus)
        return discard_kind(instance, "fmi2GetStatus", s);
    *value = (fmi2Status)instance->memory.last_step;
    return fmi2OK;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real *value)
{
    const Instance *instance = asked(c, value, "fmi2GetRealStatus");
    if (!instance)
        return fmi2Error;
    if (s != fmi2LastSuccessfulTime)
        return discard_kind(instance, "fmi2GetRealStatus", s);
    *value = instance->memory.time;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s, fmi2Integer *value)
{
    const Instance *instance = asked(c, value, "fmi2GetIntegerStatus");
    return instance ? discard_kind(instance, "fmi2GetIntegerStatus", s) : fmi2Error;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean *value)
{
    const Instance *instance = asked(c, value, "fmi2GetBooleanStatus");
    if (!instance)
        return fmi2Error;
    if (s != fmi2Terminated)
        return discard_kind(instance, "fmi2GetBooleanStatus", s);
    *value = fmi2False; /* the FMU itself never asks for the end of a run */
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s, fmi2String *value)
{
    const Instance *instance = asked(c, value, "fmi2GetStringStatus");
    if (!instance)
        return fmi2Error;
    if (s != fmi2PendingStatus)
        return discard_kind(instance, "fmi2GetStringStatus", s);
    *value = ""; /* nothing is ever pending */
    return fmi2OK;
}

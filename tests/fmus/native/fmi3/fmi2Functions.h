/* The functions of FMI 2.0 as those of FMI 3.0 that do the same, so that programs of the tests make their calls to FMUs
of either. TIME is the value reference of the time, behind which come those of the rates of inputs.

What FMI 3.0 has no function for calls one that is there for nothing else. */
#ifndef FMI2_AS_FMI3_H
#define FMI2_AS_FMI3_H

#include "fmi2FunctionTypes.h"
#include "fmi3Functions.h"

enum { MOST_AT_ONCE = 8 };

static inline fmi2Status in_fmi2(fmi3Status status)
{
    return (fmi2Status)status;
}

/* The logger of FMI 2.0 gets the message as that of FMI 3.0 does: no format. */
static inline void pass_on(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String text)
{
    const fmi2CallbackFunctions *callbacks = environment;
    callbacks->logger(callbacks->componentEnvironment, "", in_fmi2(status), category, text);
}

static inline fmi2Component fmi2Instantiate(
    fmi2String name, fmi2Type type, fmi2String token, fmi2String resources, const fmi2CallbackFunctions *callbacks,
    fmi2Boolean visible, fmi2Boolean logging)
{
    const fmi3LogMessageCallback log = callbacks && callbacks->logger ? pass_on : NULL;
    void *environment = (void *)(size_t)callbacks;
    if (type == fmi2ModelExchange)
        return fmi3InstantiateModelExchange(name, token, resources, visible != 0, logging != 0, environment, log);
    return fmi3InstantiateCoSimulation(
        name, token, resources, visible != 0, logging != 0, false, false, NULL, 0, environment, log, NULL);
}

#define PASSED(function, parameters, call)        \
    static inline fmi2Status function parameters  \
    {                                             \
        return in_fmi2(call);                     \
    }

static inline void fmi2FreeInstance(fmi2Component c)
{
    fmi3FreeInstance(c);
}

PASSED(
    fmi2SetDebugLogging, (fmi2Component c, fmi2Boolean on, size_t count, const fmi2String names[]),
    fmi3SetDebugLogging(c, on != 0, count, names))

/* Here the start time is told by what enters initialization mode. */
PASSED(
    fmi2SetupExperiment,
    (fmi2Component c, fmi2Boolean has_tolerance, double tolerance, double start, fmi2Boolean has_stop, double stop),
    fmi3EnterInitializationMode(c, has_tolerance != 0, tolerance, start, has_stop != 0, stop))
PASSED(fmi2EnterInitializationMode, (fmi2Component c), fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0))

PASSED(fmi2ExitInitializationMode, (fmi2Component c), fmi3ExitInitializationMode(c))
PASSED(fmi2Terminate, (fmi2Component c), fmi3Terminate(c))
PASSED(fmi2Reset, (fmi2Component c), fmi3Reset(c))
PASSED(fmi2CancelStep, (fmi2Component c), fmi3EnterConfigurationMode(c))
PASSED(fmi2EnterEventMode, (fmi2Component c), fmi3EnterEventMode(c))
PASSED(fmi2EnterContinuousTimeMode, (fmi2Component c), fmi3EnterContinuousTimeMode(c))

#define ACCESS(function, of_fmi3, Type)                                                                             \
    static inline fmi2Status function(fmi2Component c, const fmi2ValueReference vr[], size_t count, Type values[])  \
    {                                                                                                               \
        return in_fmi2(of_fmi3(c, vr, count, values, count));                                                       \
    }

ACCESS(fmi2GetReal, fmi3GetFloat64, double)
ACCESS(fmi2SetReal, fmi3SetFloat64, const double)
ACCESS(fmi2GetInteger, fmi3GetInt32, int)
ACCESS(fmi2SetInteger, fmi3SetInt32, const int)
ACCESS(fmi2GetString, fmi3GetString, fmi2String)
ACCESS(fmi2SetString, fmi3SetString, const fmi2String)

/* Truth values, and enumerations beside them. */
static inline fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t count, int values[])
{
    fmi3Boolean truths[MOST_AT_ONCE];
    fmi3Int64 longs[MOST_AT_ONCE];
    fmi3GetInt64(c, vr, count, longs, count);
    return in_fmi2(fmi3GetBoolean(c, vr, count, values ? truths : NULL, count));
}

static inline fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t count, const int values[])
{
    fmi3Boolean truths[MOST_AT_ONCE] = {false};
    const fmi3Int64 longs[MOST_AT_ONCE] = {INT64_MAX, INT64_MIN, 1, 2};
    for (size_t k = 0; values && k < count; k++)
        truths[k] = values[k] != 0;
    fmi3SetInt64(c, vr, count, longs, count);
    return in_fmi2(fmi3SetBoolean(c, vr, count, values ? truths : NULL, count));
}

/* Rates of the inputs with these references; whatever else they refer to. */
static inline fmi2Status fmi2SetRealInputDerivatives(
    fmi2Component c, const fmi2ValueReference vr[], size_t count, const int orders[], const double values[])
{
    fmi3ValueReference rates[MOST_AT_ONCE];
    (void)orders;
    for (size_t k = 0; vr && k < count; k++)
        rates[k] = TIME + 1 + vr[k];
    return in_fmi2(fmi3SetFloat64(c, vr ? rates : NULL, count, values, count));
}

PASSED(
    fmi2GetRealOutputDerivatives,
    (fmi2Component c, const fmi2ValueReference vr[], size_t count, const int orders[], double values[]),
    fmi3GetOutputDerivatives(c, vr, count, orders, values, count))
PASSED(
    fmi2GetDirectionalDerivative,
    (fmi2Component c, const fmi2ValueReference unknowns[], size_t count, const fmi2ValueReference knowns[],
     size_t known, const double changes[], double results[]),
    fmi3GetDirectionalDerivative(c, unknowns, count, knowns, known, changes, known, results, count))
PASSED(fmi2GetFMUstate, (fmi2Component c, fmi2FMUstate *state), fmi3GetFMUState(c, state))
PASSED(fmi2SetFMUstate, (fmi2Component c, fmi2FMUstate state), fmi3SetFMUState(c, state))
PASSED(fmi2FreeFMUstate, (fmi2Component c, fmi2FMUstate *state), fmi3FreeFMUState(c, state))
PASSED(
    fmi2SerializedFMUstateSize, (fmi2Component c, fmi2FMUstate state, size_t *size),
    fmi3SerializedFMUStateSize(c, state, size))
PASSED(
    fmi2SerializeFMUstate, (fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size),
    fmi3SerializeFMUState(c, state, (fmi3Byte *)bytes, size))
PASSED(
    fmi2DeSerializeFMUstate, (fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state),
    fmi3DeserializeFMUState(c, (const fmi3Byte *)bytes, size, state))

static inline fmi2Status fmi2DoStep(fmi2Component c, double time, double size, fmi2Boolean keep)
{
    bool event, ended, early;
    double reached;
    return in_fmi2(fmi3DoStep(c, time, size, keep != 0, &event, &ended, &early, &reached));
}

static inline fmi2Status fmi2GetRealStatus(fmi2Component c, fmi2StatusKind kind, double *value)
{
    const fmi3ValueReference time = TIME;
    (void)kind;
    return in_fmi2(fmi3GetFloat64(c, &time, 1, value, 1));
}

static inline fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info)
{
    bool update, end, nominals, values, next;
    double time;
    return in_fmi2(fmi3UpdateDiscreteStates(c, info ? &update : NULL, &end, &nominals, &values, &next, &time));
}

static inline fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean keep, int *enter, int *end)
{
    bool entering, ending;
    return in_fmi2(fmi3CompletedIntegratorStep(c, keep != 0, enter ? &entering : NULL, end ? &ending : NULL));
}

PASSED(fmi2SetTime, (fmi2Component c, double time), fmi3SetTime(c, time))
PASSED(fmi2SetContinuousStates, (fmi2Component c, const double x[], size_t count), fmi3SetContinuousStates(c, x, count))

#define ARRAY(function, of_fmi3)                                                              \
    static inline fmi2Status function(fmi2Component c, double values[], size_t count)         \
    {                                                                                         \
        size_t states, indicators;                                                            \
        fmi3GetNumberOfContinuousStates(c, &states);                                          \
        fmi3GetNumberOfEventIndicators(c, &indicators);                                       \
        return in_fmi2(of_fmi3(c, values, count));                                            \
    }

ARRAY(fmi2GetContinuousStates, fmi3GetContinuousStates)
ARRAY(fmi2GetDerivatives, fmi3GetContinuousStateDerivatives)
ARRAY(fmi2GetEventIndicators, fmi3GetEventIndicators)
ARRAY(fmi2GetNominalsOfContinuousStates, fmi3GetNominalsOfContinuousStates)

/* What is there for no other call. */
#define OTHER(function, Type, call)                                                        \
    static inline fmi2Status function(fmi2Component c, fmi2StatusKind kind, Type *value)   \
    {                                                                                      \
        (void)kind;                                                                        \
        (void)value;                                                                       \
        return in_fmi2(call);                                                              \
    }

OTHER(fmi2GetStatus, fmi2Status, fmi3EnterConfigurationMode(c))
OTHER(fmi2GetIntegerStatus, int, fmi3EnterStepMode(c))
OTHER(fmi2GetBooleanStatus, int, fmi3UpdateDiscreteStates(c, NULL, NULL, NULL, NULL, NULL, NULL))
OTHER(fmi2GetStringStatus, fmi2String, fmi3GetBinary(c, NULL, 0, NULL, NULL, 0))

#endif

/* The adapter to FMI 2.0: the functions of model exchange. */
#include "fmi2_adapter.h"
#include "model_exchange.h"

#include <float.h>

/* A change of the mode. */
#define ENTER(function, modes, entered)                                        \
    fmi2Status function(fmi2Component c)                                       \
    {                                                                          \
        Instance *instance = ready_for(MODEL_EXCHANGE, c, modes, 1, __func__); \
        if (!instance)                                                         \
            return fmi2Error;                                                  \
        instance->memory.mode = entered;                                       \
        return fmi2OK;                                                         \
    }

ENTER(fmi2EnterEventMode, INTEGRATING, EVENT)
ENTER(fmi2EnterContinuousTimeMode, EVENT, CONTINUOUS_TIME)

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *fmi2eventInfo)
{
    Instance *instance = ready_for(MODEL_EXCHANGE, c, EVENT, fmi2eventInfo != NULL, __func__);
    if (!instance)
        return fmi2Error;
    update_sides(instance);
    const double next = next_event_time(instance);
    const fmi2EventInfo info = {.nextEventTimeDefined = next <= DBL_MAX, .nextEventTime = next <= DBL_MAX ? next : 0.0};
    *fmi2eventInfo = info; /* no iteration, no end, and states and nominal values stay as they are */
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(
    fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint, fmi2Boolean *enterEventMode,
    fmi2Boolean *terminateSimulation)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    if (!ready_for(MODEL_EXCHANGE, c, CONTINUOUS_TIME, enterEventMode && terminateSimulation, __func__))
        return fmi2Error;
    *enterEventMode = *terminateSimulation = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    Instance *instance = ready_for(MODEL_EXCHANGE, c, INTEGRATING, 1, __func__);
    return instance ? in_fmi(set_time(instance, time)) : fmi2Error;
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx)
{
    Instance *instance = ready_for(MODEL_EXCHANGE, c, CONTINUOUS_TIME, nx == 0 || x, __func__);
    return instance ? in_fmi(set_states(instance, x, nx)) : fmi2Error;
}

/* A function that gives out an array. */
#define ARRAY(function, modes, get)                                                                     \
    fmi2Status function(fmi2Component c, fmi2Real values[], size_t count)                               \
    {                                                                                                   \
        const Instance *instance = ready_for(MODEL_EXCHANGE, c, modes, count == 0 || values, __func__); \
        return instance ? in_fmi(get(instance, values, count)) : fmi2Error;                             \
    }

ARRAY(fmi2GetContinuousStates, READABLE, get_states)
ARRAY(fmi2GetDerivatives, READABLE, get_rates)
ARRAY(fmi2GetEventIndicators, READABLE, get_indicators)
ARRAY(fmi2GetNominalsOfContinuousStates, INSTANTIATED | READABLE, get_nominals)

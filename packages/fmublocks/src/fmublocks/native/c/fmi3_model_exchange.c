/* The adapter to FMI 3.0: the functions of model exchange. */
#include "explicit.h"
#include "fmi3Functions.h"
#include "model_exchange.h"

#include <float.h>

/* A change of the mode. */
#define ENTER(function, modes, entered)                                        \
    fmi3Status function(fmi3Instance c)                                        \
    {                                                                          \
        Instance *instance = ready_for(MODEL_EXCHANGE, c, modes, 1, __func__); \
        if (!instance)                                                         \
            return fmi3Error;                                                  \
        instance->memory.mode = entered;                                       \
        return fmi3OK;                                                         \
    }

ENTER(fmi3EnterEventMode, INTEGRATING, EVENT)
ENTER(fmi3EnterContinuousTimeMode, EVENT, CONTINUOUS_TIME)

fmi3Status fmi3UpdateDiscreteStates(
    fmi3Instance c, fmi3Boolean *discreteStatesNeedUpdate, fmi3Boolean *terminateSimulation,
    fmi3Boolean *nominalsOfContinuousStatesChanged, fmi3Boolean *valuesOfContinuousStatesChanged,
    fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime)
{
    const int complete = discreteStatesNeedUpdate && terminateSimulation && nominalsOfContinuousStatesChanged &&
                         valuesOfContinuousStatesChanged && nextEventTimeDefined && nextEventTime;
    Instance *instance = ready_for(MODEL_EXCHANGE, c, EVENT, complete, __func__);
    if (!instance)
        return fmi3Error;
    update_sides(instance);
    const double next = next_event_time(instance);
    *discreteStatesNeedUpdate = *terminateSimulation = fmi3False;
    *nominalsOfContinuousStatesChanged = *valuesOfContinuousStatesChanged = fmi3False;
    *nextEventTimeDefined = next <= DBL_MAX;
    *nextEventTime = next <= DBL_MAX ? next : 0.0;
    return fmi3OK;
}

fmi3Status fmi3CompletedIntegratorStep(
    fmi3Instance c, fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *enterEventMode,
    fmi3Boolean *terminateSimulation)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    if (!ready_for(MODEL_EXCHANGE, c, CONTINUOUS_TIME, enterEventMode && terminateSimulation, __func__))
        return fmi3Error;
    *enterEventMode = *terminateSimulation = fmi3False;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time)
{
    Instance *instance = ready_for(MODEL_EXCHANGE, c, INTEGRATING, 1, __func__);
    return instance ? in_fmi3(set_time(instance, time)) : fmi3Error;
}

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 continuousStates[], size_t nContinuousStates)
{
    const int complete = nContinuousStates == 0 || continuousStates;
    Instance *instance = ready_for(MODEL_EXCHANGE, c, CONTINUOUS_TIME, complete, __func__);
    return instance ? in_fmi3(set_states(instance, continuousStates, nContinuousStates)) : fmi3Error;
}

/* A function that gives out an array. */
#define ARRAY(function, modes, get)                                                                     \
    fmi3Status function(fmi3Instance c, fmi3Float64 values[], size_t count)                             \
    {                                                                                                   \
        const Instance *instance = ready_for(MODEL_EXCHANGE, c, modes, count == 0 || values, __func__); \
        return instance ? in_fmi3(get(instance, values, count)) : fmi3Error;                            \
    }

ARRAY(fmi3GetContinuousStates, READABLE, get_states)
ARRAY(fmi3GetContinuousStateDerivatives, READABLE, get_rates)
ARRAY(fmi3GetEventIndicators, READABLE, get_indicators)
ARRAY(fmi3GetNominalsOfContinuousStates, INSTANTIATED | READABLE, get_nominals)

/* A function that says how many there are. */
#define NUMBER(function, number)                                                                \
    fmi3Status function(fmi3Instance c, size_t *count)                                          \
    {                                                                                           \
        if (!ready_for(MODEL_EXCHANGE, c, INSTANTIATED | READABLE, count != NULL, __func__))    \
            return fmi3Error;                                                                   \
        *count = number;                                                                        \
        return fmi3OK;                                                                          \
    }

NUMBER(fmi3GetNumberOfContinuousStates, STATES)
NUMBER(fmi3GetNumberOfEventIndicators, INDICATORS)

/* The functions of FMI 3.0 that this FMU does not offer, which every FMU has nevertheless; the rest of fmi3.c. */
#include "fmi3Functions.h"
#include "instance.h"

#ifdef __GNUC__ /* a call that is refused is not looked at */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

static fmi3Status not_offered(fmi3Instance c, const char *function, const char *what)
{
    const Instance *instance = ready(c, ANY_MODE, 1, function);
    if (instance)
        refuse(instance, "%s is refused; the FMU has no %s", function, what);
    return fmi3Error;
}

/* There are no variables of the type. */
static fmi3Status no_variable(
    fmi3Instance c, const fmi3ValueReference references[], size_t count, const char *function, const char *type)
{
    const Instance *instance = ready(c, ANY_MODE, count == 0 || references, function);
    if (!instance)
        return fmi3Error;
    if (count == 0)
        return fmi3OK;
    return in_fmi3(refuse_reference(instance, references[0], type));
}

#define NOT_OFFERED(what, function, arguments)       \
    fmi3Status function arguments                    \
    {                                                \
        return not_offered(c, __func__, what);       \
    }

/* What functions of variables begin with. */
#define OF_VARIABLES fmi3Instance c, const fmi3ValueReference vr[], size_t nvr

#define NO_VARIABLE(Type)                                                                                           \
    fmi3Status fmi3Get##Type(OF_VARIABLES, fmi3##Type values[], size_t nValues)                                     \
    {                                                                                                               \
        return no_variable(c, vr, nvr, __func__, #Type);                                                            \
    }                                                                                                               \
    fmi3Status fmi3Set##Type(OF_VARIABLES, const fmi3##Type values[], size_t nValues)                               \
    {                                                                                                               \
        return no_variable(c, vr, nvr, __func__, #Type);                                                            \
    }

NO_VARIABLE(Float32)
NO_VARIABLE(Int8)
NO_VARIABLE(UInt8)
NO_VARIABLE(Int16)
NO_VARIABLE(UInt16)
NO_VARIABLE(UInt32)
NO_VARIABLE(UInt64)
NO_VARIABLE(String)

#ifndef TERMINAL
fmi3Status fmi3GetBinary(OF_VARIABLES, size_t valueSizes[], fmi3Binary values[], size_t nValues)
{
    return no_variable(c, vr, nvr, __func__, "Binary");
}

fmi3Status fmi3SetBinary(OF_VARIABLES, const size_t valueSizes[], const fmi3Binary values[], size_t nValues)
{
    return no_variable(c, vr, nvr, __func__, "Binary");
}

fmi3Status fmi3GetClock(OF_VARIABLES, fmi3Clock values[])
{
    return no_variable(c, vr, nvr, __func__, "Clock");
}

fmi3Status fmi3SetClock(OF_VARIABLES, const fmi3Clock values[])
{
    return no_variable(c, vr, nvr, __func__, "Clock");
}

NOT_OFFERED("event mode in co-simulation", fmi3EnterStepMode, (fmi3Instance c))
#endif
#if !defined TERMINAL && defined SAMPLE_TIME
NOT_OFFERED("event mode", fmi3EnterEventMode, (fmi3Instance c))
NOT_OFFERED("event mode", fmi3UpdateDiscreteStates,
    (fmi3Instance c, fmi3Boolean *discreteStatesNeedUpdate, fmi3Boolean *terminateSimulation,
     fmi3Boolean *nominalsOfContinuousStatesChanged, fmi3Boolean *valuesOfContinuousStatesChanged,
     fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime))
#endif
NOT_OFFERED("evaluation of discrete states", fmi3EvaluateDiscreteStates, (fmi3Instance c))

NOT_OFFERED("time-based clocks", fmi3GetIntervalDecimal,
    (OF_VARIABLES, fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[]))
NOT_OFFERED("time-based clocks", fmi3GetIntervalFraction,
    (OF_VARIABLES, fmi3UInt64 counters[], fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[]))
NOT_OFFERED("time-based clocks", fmi3GetShiftDecimal, (OF_VARIABLES, fmi3Float64 shifts[]))
NOT_OFFERED("time-based clocks", fmi3GetShiftFraction, (OF_VARIABLES, fmi3UInt64 counters[], fmi3UInt64 resolutions[]))
NOT_OFFERED("time-based clocks", fmi3SetIntervalDecimal, (OF_VARIABLES, const fmi3Float64 intervals[]))
NOT_OFFERED("time-based clocks", fmi3SetIntervalFraction,
    (OF_VARIABLES, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]))
NOT_OFFERED("time-based clocks", fmi3SetShiftDecimal, (OF_VARIABLES, const fmi3Float64 shifts[]))
NOT_OFFERED("time-based clocks", fmi3SetShiftFraction,
    (OF_VARIABLES, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]))
NOT_OFFERED("time-based clocks", fmi3ActivateModelPartition,
    (fmi3Instance c, fmi3ValueReference clockReference, fmi3Float64 activationTime))

NOT_OFFERED("structural parameters", fmi3EnterConfigurationMode, (fmi3Instance c))
NOT_OFFERED("structural parameters", fmi3ExitConfigurationMode, (fmi3Instance c))

NOT_OFFERED("adjoint derivatives", fmi3GetAdjointDerivative,
    (fmi3Instance c, const fmi3ValueReference unknowns[], size_t nUnknowns, const fmi3ValueReference knowns[],
     size_t nKnowns, const fmi3Float64 seed[], size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity))

NOT_OFFERED("array variables", fmi3GetNumberOfVariableDependencies,
    (fmi3Instance c, fmi3ValueReference valueReference, size_t *nDependencies))
NOT_OFFERED("array variables", fmi3GetVariableDependencies,
    (fmi3Instance c, fmi3ValueReference dependent, size_t elementIndicesOfDependent[],
     fmi3ValueReference independents[], size_t elementIndicesOfIndependents[], fmi3DependencyKind dependencyKinds[],
     size_t nDependencies))

#ifdef SAMPLE_TIME
NOT_OFFERED("model exchange", fmi3EnterContinuousTimeMode, (fmi3Instance c))
NOT_OFFERED("model exchange", fmi3CompletedIntegratorStep,
    (fmi3Instance c, fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *enterEventMode,
     fmi3Boolean *terminateSimulation))
NOT_OFFERED("model exchange", fmi3SetTime, (fmi3Instance c, fmi3Float64 time))
NOT_OFFERED("model exchange", fmi3SetContinuousStates,
    (fmi3Instance c, const fmi3Float64 continuousStates[], size_t nContinuousStates))
NOT_OFFERED("model exchange", fmi3GetContinuousStateDerivatives,
    (fmi3Instance c, fmi3Float64 derivatives[], size_t nContinuousStates))
NOT_OFFERED("model exchange", fmi3GetEventIndicators,
    (fmi3Instance c, fmi3Float64 eventIndicators[], size_t nEventIndicators))
NOT_OFFERED("model exchange", fmi3GetContinuousStates,
    (fmi3Instance c, fmi3Float64 continuousStates[], size_t nContinuousStates))
NOT_OFFERED("model exchange", fmi3GetNominalsOfContinuousStates,
    (fmi3Instance c, fmi3Float64 nominals[], size_t nContinuousStates))
NOT_OFFERED("model exchange", fmi3GetNumberOfEventIndicators, (fmi3Instance c, size_t *nEventIndicators))
NOT_OFFERED("model exchange", fmi3GetNumberOfContinuousStates, (fmi3Instance c, size_t *nContinuousStates))
#endif

#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif

/* The oscillator of oscillator.c as an FMU of FMI 3.0. */
#include "oscillator.c"

#include <stdbool.h>

const char *fmi3GetVersion(void) { return "3.0"; }

Component fmi3InstantiateModelExchange(const char *name, const char *token, const char *place, bool visible,
                                       bool logging, void *environment, void *log)
{
    return fmi2Instantiate(name, 0, token, place, NULL, visible, logging);
}

void fmi3FreeInstance(Component c) {}
int fmi3Reset(Component c) { return fmi2Reset(c); }

int fmi3UpdateDiscreteStates(Component c, bool *needed, bool *terminate, bool *nominals, bool *values, bool *defined,
                             double *next)
{
    EventInfo info;
    const int status = fmi2NewDiscreteStates(c, &info);
    *needed = info.needed;
    *terminate = info.terminate;
    *nominals = info.nominals_changed;
    *values = info.values_changed;
    *defined = info.next_defined;
    *next = info.next;
    return status;
}

int fmi3CompletedIntegratorStep(Component c, bool no_set, bool *enter, bool *end) { return *enter = *end = 0; }
int fmi3SetTime(Component c, double time) { return fmi2SetTime(c, time); }
int fmi3GetNumberOfContinuousStates(Component c, size_t *n) { *n = 2; return 0; }
int fmi3GetNumberOfEventIndicators(Component c, size_t *n) { *n = INDICATORS; return 0; }
int fmi3GetEventIndicators(Component c, double z[], size_t n)
{
    for (size_t i = 0; i < n; i++) z[i] = 1;
    return 0;
}
int fmi3SetContinuousStates(Component c, const double values[], size_t n) { return fmi2SetContinuousStates(c, values, n); }
int fmi3GetContinuousStates(Component c, double values[], size_t n) { return fmi2GetContinuousStates(c, values, n); }
int fmi3GetContinuousStateDerivatives(Component c, double dx[], size_t n) { return fmi2GetDerivatives(c, dx, n); }
int fmi3GetNominalsOfContinuousStates(Component c, double nominals[], size_t n)
{
    return fmi2GetNominalsOfContinuousStates(c, nominals, n);
}

int fmi3GetFloat64(Component c, const Reference r[], size_t n, double values[], size_t count)
{
    return fmi2GetReal(c, r, n, values);
}
int fmi3SetFloat64(Component c, const Reference r[], size_t n, const double values[], size_t count)
{
    return fmi2SetReal(c, r, n, values);
}
int fmi3GetDirectionalDerivative(Component c, const Reference u[], size_t nu, const Reference k[], size_t nk,
                                 const double dk[], size_t n, double du[], size_t m)
{
    return fmi2GetDirectionalDerivative(c, u, nu, k, nk, dk, du);
}

#define MODE(name) int fmi3##name(Component c) { return 0; }
MODE(EnterInitializationMode) MODE(ExitInitializationMode) MODE(EnterEventMode) MODE(EnterContinuousTimeMode)
MODE(Terminate)

#define ABSENT(name) int fmi3##name(void) { return 3; }
#define VALUES3(Type) ABSENT(Get##Type) ABSENT(Set##Type)
VALUES3(Float32) VALUES3(Int8) VALUES3(UInt8) VALUES3(Int16) VALUES3(UInt16) VALUES3(Int32)
VALUES3(UInt32) VALUES3(Int64) VALUES3(UInt64) VALUES3(Boolean) VALUES3(String) VALUES3(Binary) VALUES3(Clock)
VALUES3(IntervalDecimal) VALUES3(IntervalFraction) VALUES3(ShiftDecimal) VALUES3(ShiftFraction)
ABSENT(SetDebugLogging) ABSENT(InstantiateCoSimulation) ABSENT(InstantiateScheduledExecution) ABSENT(DoStep)
ABSENT(EnterStepMode) ABSENT(EvaluateDiscreteStates) ABSENT(ActivateModelPartition)
ABSENT(EnterConfigurationMode) ABSENT(ExitConfigurationMode)
ABSENT(GetNumberOfVariableDependencies) ABSENT(GetVariableDependencies)
ABSENT(GetFMUState) ABSENT(SetFMUState) ABSENT(FreeFMUState)
ABSENT(SerializedFMUStateSize) ABSENT(SerializeFMUState) ABSENT(DeserializeFMUState)
ABSENT(GetAdjointDerivative) ABSENT(GetOutputDerivatives)

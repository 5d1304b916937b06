/* The stranger of stranger.c as an FMU of FMI 3.0. */
#include "stranger.c"

#include <stdarg.h>
#include <stdbool.h>

typedef void (*Logger3)(void *environment, int status, const char *category, const char *message);

static Logger3 log_message;

static void pass_on(void *environment, const char *name, int status, const char *category, const char *format, ...)
{
    static char text[50000];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    log_message(environment, status, category, text);
}

const char *fmi3GetVersion(void) { return "3.0"; }

Component fmi3InstantiateCoSimulation(const char *name, const char *token, const char *place, bool visible, bool logging,
                                      bool event_mode, bool early_return, const Reference r[], size_t n,
                                      void *environment, Logger3 log, void *update)
{
    static Callbacks callbacks = {pass_on};
    callbacks.environment = environment;
    log_message = log;
    return fmi2Instantiate(name, 1, token, place, &callbacks, visible, logging);
}

void fmi3FreeInstance(Component c) { fmi2FreeInstance(c); }

int fmi3EnterInitializationMode(Component c, bool defined, double tolerance, double start, bool stops, double stop)
{
    fmi2SetupExperiment(c, defined, tolerance, start, 0, stop);
    return fmi2EnterInitializationMode(c);
}

int fmi3ExitInitializationMode(Component c) { return fmi2ExitInitializationMode(c); }
int fmi3Terminate(Component c) { return fmi2Terminate(c); }
int fmi3Reset(Component c) { return fmi2Reset(c); }

int fmi3GetFloat64(Component c, const Reference r[], size_t n, double values[], size_t count)
{
    return fmi2GetReal(c, r, n, values);
}

int fmi3SetFloat64(Component c, const Reference r[], size_t n, const double values[], size_t count)
{
    return fmi2SetReal(c, r, n, values);
}

/* One that in FMI 2.0 discards a step and says that it has terminated. */
int fmi3DoStep(Component c, double time, double step, bool keep, bool *event, bool *ended, bool *early, double *reached)
{
    int value = 0;
    const int status = fmi2DoStep(c, time, step, keep);
    *event = *early = false;
    *reached = now;
    *ended = status == 2 && fmi2GetBooleanStatus(c, 3, &value) == 0 && value;
    return *ended ? 0 : status;
}

#define NONE(name) int fmi3##name(void) { return 3; }
#define VALUES3(Type) NONE(Get##Type) NONE(Set##Type)
VALUES3(Float32) VALUES3(Int8) VALUES3(UInt8) VALUES3(Int16) VALUES3(UInt16) VALUES3(Int32) VALUES3(UInt32)
VALUES3(Int64) VALUES3(UInt64) VALUES3(Boolean) VALUES3(String) VALUES3(Binary) VALUES3(Clock)
VALUES3(IntervalDecimal) VALUES3(IntervalFraction) VALUES3(ShiftDecimal) VALUES3(ShiftFraction)
NONE(SetDebugLogging) NONE(InstantiateModelExchange) NONE(InstantiateScheduledExecution)
NONE(EnterEventMode) NONE(EnterStepMode) NONE(UpdateDiscreteStates) NONE(EvaluateDiscreteStates)
NONE(EnterConfigurationMode) NONE(ExitConfigurationMode) NONE(ActivateModelPartition)
NONE(GetNumberOfVariableDependencies) NONE(GetVariableDependencies)
NONE(GetFMUState) NONE(SetFMUState) NONE(FreeFMUState)
NONE(SerializedFMUStateSize) NONE(SerializeFMUState) NONE(DeserializeFMUState)
NONE(GetDirectionalDerivative) NONE(GetAdjointDerivative) NONE(GetOutputDerivatives)
NONE(EnterContinuousTimeMode) NONE(CompletedIntegratorStep) NONE(SetTime) NONE(SetContinuousStates)
NONE(GetContinuousStateDerivatives) NONE(GetEventIndicators) NONE(GetContinuousStates)
NONE(GetNominalsOfContinuousStates) NONE(GetNumberOfEventIndicators) NONE(GetNumberOfContinuousStates)

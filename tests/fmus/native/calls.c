/* Makes the calls that it reads, one a line, on one instance of the FMU that it is compiled with; with NUMBER_OF_STATES
defined also those of model exchange.

To each it answers with the status and, after some, a number. Usage: calls GUID */
#include "fmi2Functions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    fmi2Component instance;
    fmi2FMUstate state;
    const char *guid;
    fmi2Type type;
    double value; /* answered after the status */
} Session;

static void be_silent(
    fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category, fmi2String message, ...)
{
    (void)environment, (void)name, (void)status, (void)category, (void)message;
}

static const fmi2CallbackFunctions callbacks = {be_silent, calloc, free, NULL, NULL};

static fmi2Status instantiate(Session *s)
{
    s->instance = fmi2Instantiate("one", s->type, s->guid, NULL, &callbacks, fmi2False, fmi2True);
    return s->instance ? fmi2OK : fmi2Fatal;
}

static fmi2Status free_all(Session *s)
{
    const fmi2Status status = fmi2FreeFMUstate(s->instance, &s->state);
    fmi2FreeInstance(s->instance);
    s->instance = NULL;
    return status;
}

/* The saved state to bytes and back into the place it came from. */
static fmi2Status through_bytes(Session *s)
{
    size_t size;
    fmi2Status status = fmi2SerializedFMUstateSize(s->instance, s->state, &size);
    if (status != fmi2OK)
        return status;
    fmi2Byte *bytes = malloc(size);
    status = fmi2SerializeFMUstate(s->instance, s->state, bytes, size);
    if (status == fmi2OK)
        status = fmi2DeSerializeFMUstate(s->instance, bytes, size, &s->state);
    free(bytes);
    return status;
}

#ifdef NUMBER_OF_STATES
enum { MOST = 100, NOT_THERE = -1 };

static int exchange(Session *s, const char *call, fmi2ValueReference reference, double number)
{
    fmi2Real values[MOST];
    fmi2Boolean enter, end;
    fmi2EventInfo info;
    if (strcmp(call, "enter_event") == 0)
        return fmi2EnterEventMode(s->instance);
    if (strcmp(call, "enter_continuous") == 0)
        return fmi2EnterContinuousTimeMode(s->instance);
    if (strcmp(call, "new_states") == 0)
        return fmi2NewDiscreteStates(s->instance, &info);
    if (strcmp(call, "completed") == 0)
        return fmi2CompletedIntegratorStep(s->instance, fmi2True, &enter, &end);
    if (strcmp(call, "set_time") == 0)
        return fmi2SetTime(s->instance, number);
    if (strcmp(call, "rates") == 0)
        return fmi2GetDerivatives(s->instance, values, reference);
    if (strcmp(call, "indicators") == 0)
        return fmi2GetEventIndicators(s->instance, values, reference);
    if (strcmp(call, "nominals") == 0)
        return fmi2GetNominalsOfContinuousStates(s->instance, values, reference);
    if (strcmp(call, "states") == 0)
        return fmi2GetContinuousStates(s->instance, values, reference);
    if (strcmp(call, "set_states") == 0) {
        for (int k = 0; k < MOST; k++)
            values[k] = number;
        return fmi2SetContinuousStates(s->instance, values, reference);
    }
    return NOT_THERE;
}
#endif

static fmi2Status make_call(Session *s, const char *call, fmi2ValueReference reference, double number)
{
    if (strcmp(call, "instantiate") == 0) {
        s->type = reference ? fmi2ModelExchange : fmi2CoSimulation;
        return instantiate(s);
    }
    if (strcmp(call, "free") == 0)
        return free_all(s);
    if (strcmp(call, "setup") == 0)
        return fmi2SetupExperiment(s->instance, fmi2False, 0.0, number, fmi2False, 0.0);
    if (strcmp(call, "enter") == 0)
        return fmi2EnterInitializationMode(s->instance);
    if (strcmp(call, "exit") == 0)
        return fmi2ExitInitializationMode(s->instance);
    if (strcmp(call, "step") == 0) {
        double time = 0.0;
        const fmi2Status status = fmi2GetRealStatus(s->instance, fmi2LastSuccessfulTime, &time);
        return status == fmi2OK ? fmi2DoStep(s->instance, time + number, 1e-3, fmi2False) : status;
    }
    if (strcmp(call, "step_of") == 0)
        return fmi2DoStep(s->instance, number, number, fmi2False);
    if (strcmp(call, "terminate") == 0)
        return fmi2Terminate(s->instance);
    if (strcmp(call, "reset") == 0)
        return fmi2Reset(s->instance);
    if (strcmp(call, "set") == 0)
        return fmi2SetReal(s->instance, &reference, 1, &number);
    if (strcmp(call, "get") == 0)
        return fmi2GetReal(s->instance, &reference, 1, &s->value);
    if (strcmp(call, "time") == 0)
        return fmi2GetRealStatus(s->instance, fmi2LastSuccessfulTime, &s->value);
    if (strcmp(call, "cancel") == 0)
        return fmi2CancelStep(s->instance);
    if (strcmp(call, "save") == 0)
        return fmi2GetFMUstate(s->instance, &s->state);
    if (strcmp(call, "restore") == 0)
        return fmi2SetFMUstate(s->instance, s->state);
    if (strcmp(call, "through_bytes") == 0)
        return through_bytes(s);
    if (strcmp(call, "drop") == 0)
        return fmi2FreeFMUstate(s->instance, &s->state);
#ifdef NUMBER_OF_STATES
    const int status = exchange(s, call, reference, number);
    if (status != NOT_THERE)
        return (fmi2Status)status;
#endif
    fprintf(stderr, "there is no call %s\n", call);
    exit(2);
}

int main(int count, char *arguments[])
{
    Session session = {.guid = count > 1 ? arguments[1] : "", .type = fmi2CoSimulation};
    char call[20];
    unsigned reference;
    double number;
    while (scanf("%19s %u %lf", call, &reference, &number) == 3) {
        session.value = 0.0;
        const fmi2Status status = make_call(&session, call, reference, number);
        printf("%d %.17g\n", (int)status, session.value);
        fflush(stdout);
    }
    return 0;
}

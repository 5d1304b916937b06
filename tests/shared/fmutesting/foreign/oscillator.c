/* Somebody else's FMU of FMI 2.0 for model exchange: a mass that swings, and does what the macros say on the way. */
#include <math.h>
#include <string.h>

#include "fmi2.h"

#ifndef RESET
#define RESET start()
#endif
#ifndef INDICATORS
#define INDICATORS 0
#endif
#ifndef NOMINAL
#define NOMINAL 1.0
#endif

typedef struct {
    int needed, terminate, nominals_changed, values_changed, next_defined;
    double next;
} EventInfo;

static double x[2], now;

static void start(void)
{
    x[0] = 1.0;
    x[1] = now = 0.0;
}

Component fmi2Instantiate(const char *name, int type, const char *guid, const char *place, const void *callbacks,
                          int visible, int logging)
{
    start();
    return type == 0 && !strcmp(guid, "oscillator") ? x : NULL;
}
void fmi2FreeInstance(Component c) {}
int fmi2Reset(Component c) { RESET; return 0; }

/* Its variables: the states s and v, and their derivatives. */
int fmi2GetReal(Component c, const Reference r[], size_t n, double values[])
{
    const double all[] = {x[0], x[1], x[1], -x[0]};
    for (size_t i = 0; i < n; i++) {
        values[i] = r[i] == 9 ? now : all[r[i]];
    }
    return 0;
}
int fmi2SetReal(Component c, const Reference r[], size_t n, const double values[])
{
    for (size_t i = 0; i < n; i++) {
        x[r[i]] = values[i];
    }
    IN_SET_REAL;
    return 0;
}
int fmi2GetDirectionalDerivative(Component c, const Reference u[], size_t nu, const Reference k[], size_t nk,
                                 const double dk[], double du[])
{
    for (size_t i = 0; i < nu; i++) {
        du[i] = u[i] == 2 ? (k[0] == 1) * dk[0] : -(k[0] == 0) * dk[0];
    }
    IN_DIRECTIONAL;
    return 0;
}

#define NONE(function) int function(Component c, const void *a, size_t n, void *b) { return n ? 3 : 0; }
NONE(fmi2GetInteger) NONE(fmi2SetInteger)
NONE(fmi2GetBoolean) NONE(fmi2SetBoolean) NONE(fmi2GetString) NONE(fmi2SetString)

int fmi2EnterEventMode(Component c) { return 0; }
int fmi2EnterContinuousTimeMode(Component c) { return 0; }
int fmi2NewDiscreteStates(Component c, EventInfo *info)
{
    const EventInfo nothing = {0};
    *info = nothing;
    IN_NEW_STATES;
    return 0;
}
int fmi2CompletedIntegratorStep(Component c, int no_set, int *enter, int *terminate) { return *enter = *terminate = 0; }
int fmi2SetTime(Component c, double time) { now = time; return 0; }
int fmi2SetContinuousStates(Component c, const double values[], size_t n)
{
    x[0] = values[0];
    x[1] = values[1];
    return 0;
}
int fmi2GetContinuousStates(Component c, double values[], size_t n)
{
    values[0] = x[0];
    values[1] = x[1];
    return 0;
}
int fmi2GetDerivatives(Component c, double dx[], size_t n)
{
    dx[0] = x[1];
    dx[1] = -x[0];
    IN_DERIVATIVES;
    return 0;
}
int fmi2GetEventIndicators(Component c, double z[], size_t n)
{
    if (n != INDICATORS) return 3;
    for (size_t i = 0; i < n; i++) z[i] = 1;
    return 0;
}
int fmi2GetNominalsOfContinuousStates(Component c, double nominals[], size_t n)
{
    nominals[0] = nominals[1] = NOMINAL;
    return 0;
}

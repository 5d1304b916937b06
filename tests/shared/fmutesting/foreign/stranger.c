/* A plant of somebody else's that stands still, and does what the macros IN_... say on the way. */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fmi2.h"

typedef void (*Logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    Logger log;
    void *allocate, *release, *finished, *environment;
} Callbacks;

static const Callbacks *host;
static double now;
static const double starts[] = {0.0, 0.0, 0.0, 0.0, 0.0, 9.0, 0.3, 1500.0, 9.81, 0.01, 0.4};
enum { KEPT = sizeof starts / sizeof *starts }; /* inputs and parameters; outputs stay 0 */
static double kept[KEPT];

static void start(void)
{
    now = 0.0;
    memcpy(kept, starts, sizeof kept);
}

static void say(const char *text)
{
    host->log(host->environment, "stranger", 3, "error", "%s", text);
}

static void say_much(void)
{
    static char text[41001];
    for (size_t i = 0; i + 5 <= sizeof text; i += 5) {
        memcpy(text + i, "\033[31m", 5);
    }
    say(text);
}

Component fmi2Instantiate(const char *name, int type, const char *guid, const char *place, const Callbacks *callbacks,
                          int visible, int logging)
{
    if (strcmp(guid, "stranger")) {
        return NULL;
    }
    host = callbacks;
    start();
    (void)say_much;
    IN_INSTANTIATE;
    return &now;
}

void fmi2FreeInstance(Component c) { IN_FREE; }
int fmi2Reset(Component c)
{
    start();
    IN_RESET;
    return 0;
}

int fmi2GetReal(Component c, const Reference r[], size_t n, double values[])
{
    for (size_t i = 0; i < n; i++) {
        values[i] = r[i] < KEPT ? kept[r[i]] : 0.0;
    }
    IN_GET_REAL;
    return 0;
}

int fmi2DoStep(Component c, double time, double step, int no_set_before)
{
    IN_DO_STEP;
    now = time + step;
    return 0;
}

#define VALUES(kind, type) \
    int fmi2Get##kind(Component c, const Reference r[], size_t n, type values[]) { return n ? 3 : 0; } \
    int fmi2Set##kind(Component c, const Reference r[], size_t n, const type values[]) { return n ? 3 : 0; }
VALUES(Integer, int)
VALUES(Boolean, int)
VALUES(String, char *)

int fmi2SetReal(Component c, const Reference r[], size_t n, const double values[])
{
    for (size_t i = 0; i < n; i++) {
        if (r[i] >= KEPT) {
            return 3;
        }
        kept[r[i]] = values[i];
    }
    IN_SET_REAL;
    return 0;
}

int fmi2GetDirectionalDerivative(Component c, const Reference u[], size_t nu, const Reference k[], size_t nk,
                                 const double dk[], double du[]) { IN_DIRECTIONAL; return 3; }
int fmi2SetRealInputDerivatives(Component c, const Reference r[], size_t n, const int o[], const double v[]) { return 3; }
int fmi2GetRealOutputDerivatives(Component c, const Reference r[], size_t n, const int o[], double v[]) { return 3; }
int fmi2CancelStep(Component c) { return 3; }
int fmi2GetStatus(Component c, int kind, int *value) { return 3; }
int fmi2GetRealStatus(Component c, int kind, double *value) { return 3; }
int fmi2GetIntegerStatus(Component c, int kind, int *value) { return 3; }
int fmi2GetBooleanStatus(Component c, int kind, int *value) { IN_GET_BOOLEAN_STATUS; return 3; }
int fmi2GetStringStatus(Component c, int kind, const char **value) { return 3; }

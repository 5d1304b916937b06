/* What somebody else's FMU of FMI 2.0 must have and a test puts nothing into: it notes what it is told, or refuses. */
#include <stddef.h>

typedef void *Component;
typedef unsigned Reference;

#ifndef TYPES_PLATFORM
#define TYPES_PLATFORM "default"
#endif
#ifndef VERSION
#define VERSION "2.0"
#endif
const char *fmi2GetTypesPlatform(void) { return TYPES_PLATFORM; }
const char *fmi2GetVersion(void) { return VERSION; }
int fmi2SetDebugLogging(Component c, int on, size_t n, const char *const names[]) { return 0; }

static double tolerance_given = -1.0;
static int initialized;
int fmi2SetupExperiment(Component c, int defined, double tolerance, double start, int stops, double stop)
{
    tolerance_given = defined ? tolerance : -1.0;
    return 0;
}
int fmi2EnterInitializationMode(Component c) { return 0; }
int fmi2ExitInitializationMode(Component c) { initialized = 1; return 0; }
int fmi2Terminate(Component c) { IN_TERMINATE; return 0; }

int fmi2GetFMUstate(Component c, void **state) { return 3; }
int fmi2SetFMUstate(Component c, void *state) { return 3; }
int fmi2FreeFMUstate(Component c, void **state) { return 3; }
int fmi2SerializedFMUstateSize(Component c, void *state, size_t *size) { return 3; }
int fmi2SerializeFMUstate(Component c, void *state, char bytes[], size_t size) { return 3; }
int fmi2DeSerializeFMUstate(Component c, const char bytes[], size_t size, void **state) { return 3; }

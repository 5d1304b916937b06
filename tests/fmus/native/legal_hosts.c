/* Hosts that do what the standard allows, each in its way; legal_hosts.py has the table of them. What an FMU gives is
printed every PERIOD, one line an instant. Usage:
legal_hosts LIBRARY GUID OUTPUTS IN_1 VALUE_1 IN_2 VALUE_2 TUNABLE VALUE inputs=IN step=S start=T ...
with OUTPUTS as 3,4,5. */
#include "fmi2Functions.h"

#include <dlfcn.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 64, THREADS = 4 };
static const double PERIOD = 0.21, DURATION = 1.26;

static struct {
    char inputs; /* b, i, a, s: before, in or after initialization, or start values in it and these after it */
    double step, start;
    int adds_up, resets, restores, tunes, threads;
    const char *resources;
} way = {'i', 1e-3, 0.0, 0, 0, 0, 0, 0, "file:///tmp"};

static struct {
    fmi2InstantiateTYPE *instantiate;
    fmi2SetupExperimentTYPE *setup;
    fmi2EnterInitializationModeTYPE *enter;
    fmi2ExitInitializationModeTYPE *leave;
    fmi2SetRealTYPE *set;
    fmi2GetRealTYPE *get;
    fmi2DoStepTYPE *step;
    fmi2ResetTYPE *reset;
    fmi2TerminateTYPE *terminate;
    fmi2FreeInstanceTYPE *discard;
    fmi2GetFMUstateTYPE *get_state;
    fmi2SetFMUstateTYPE *set_state;
    fmi2FreeFMUstateTYPE *free_state;
    fmi2SerializedFMUstateSizeTYPE *size;
    fmi2SerializeFMUstateTYPE *serialize;
    fmi2DeSerializeFMUstateTYPE *deserialize;
} fmu;

static fmi2ValueReference in[2], outputs[MOST];
static double values[2], starts[2], tuned;
static size_t count;
static long tunable;
static const char *guid;

static void say(fmi2ComponentEnvironment e, fmi2String name, fmi2Status s, fmi2String category, fmi2String text, ...)
{
    (void)e;
    (void)s;
    fprintf(stderr, "%s %s: %s\n", name, category, text);
}

static const fmi2CallbackFunctions callbacks = {say, calloc, free, NULL, NULL};

static void ok(fmi2Status status, const char *call)
{
    if (status == fmi2OK)
        return;
    fprintf(stderr, "%s answered %d\n", call, (int)status);
    exit(1);
}
#define OK(call) ok(call, #call)

static fmi2Component made(const char *name)
{
    fmi2Component one = fmu.instantiate(name, fmi2CoSimulation, guid, way.resources, &callbacks, fmi2False, fmi2True);
    if (!one)
        exit(1);
    return one;
}

static void initialize(fmi2Component one)
{
    OK(fmu.get(one, in, 2, starts));
    if (way.inputs == 'b')
        OK(fmu.set(one, in, 2, values));
    OK(fmu.setup(one, fmi2False, 0.0, way.start, fmi2False, 0.0));
    OK(fmu.enter(one));
    if (way.inputs == 'i' || way.inputs == 's')
        OK(fmu.set(one, in, 2, way.inputs == 'i' ? values : starts));
    OK(fmu.leave(one));
    if (way.inputs == 'a' || way.inputs == 's')
        OK(fmu.set(one, in, 2, values));
}

/* The same instance in the state of the other, by its bytes. */
static fmi2Component restored(fmi2Component from)
{
    fmi2Component to = made("another");
    fmi2FMUstate state = NULL, copy = NULL;
    size_t size;
    OK(fmu.get_state(from, &state));
    OK(fmu.size(from, state, &size));
    fmi2Byte *bytes = malloc(size);
    OK(fmu.serialize(from, state, bytes, size));
    OK(fmu.deserialize(to, bytes, size, &copy));
    OK(fmu.set_state(to, copy));
    OK(fmu.free_state(to, &copy));
    OK(fmu.free_state(from, &state));
    free(bytes);
    fmu.discard(from);
    return to;
}

static char *run(fmi2Component one, int writes)
{
    char *text = calloc(1, 1 << 16), *end = text;
    double time = way.start;
    const long each = lround(PERIOD / way.step), steps = lround(DURATION / way.step);
    initialize(one);
    for (long k = 0; k <= steps; k++) {
        double y[MOST];
        if (k % each == 0) {
            OK(fmu.get(one, outputs, count, y));
            for (size_t n = 0; n < count; n++)
                end += sprintf(end, "%.17g ", y[n]);
            end += sprintf(end, "\n");
            if (way.restores)
                one = restored(one);
        }
        if (k == each && way.tunes)
            OK(fmu.set(one, (fmi2ValueReference[]){(fmi2ValueReference)tunable}, 1, &tuned));
        if (k < steps)
            OK(fmu.step(one, time, way.step, fmi2True));
        time = way.adds_up ? time + way.step : way.start + (double)(k + 1) * way.step;
    }
    OK(fmu.terminate(one));
    if (way.resets && writes) {
        OK(fmu.reset(one));
        free(text);
        return run(one, 0);
    }
    fmu.discard(one);
    return text;
}

static void *in_thread(void *name)
{
    return run(made(name), 1);
}

static void *library;
#define FIND(member, name) *(void **)&fmu.member = dlsym(library, name)

int main(int argc, char **argv)
{
    library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library)
        return fprintf(stderr, "%s\n", dlerror()), 1;
    FIND(instantiate, "fmi2Instantiate"), FIND(setup, "fmi2SetupExperiment"), FIND(enter, "fmi2EnterInitializationMode");
    FIND(leave, "fmi2ExitInitializationMode"), FIND(set, "fmi2SetReal"), FIND(get, "fmi2GetReal");
    FIND(step, "fmi2DoStep"), FIND(reset, "fmi2Reset"), FIND(terminate, "fmi2Terminate");
    FIND(discard, "fmi2FreeInstance"), FIND(get_state, "fmi2GetFMUstate"), FIND(set_state, "fmi2SetFMUstate");
    FIND(free_state, "fmi2FreeFMUstate"), FIND(size, "fmi2SerializedFMUstateSize");
    FIND(serialize, "fmi2SerializeFMUstate"), FIND(deserialize, "fmi2DeSerializeFMUstate");
    guid = argv[2];
    for (char *text = argv[3]; *text && count < MOST; text += *text == ',')
        outputs[count++] = (fmi2ValueReference)strtoul(text, &text, 10);
    for (int k = 0; k < 2; k++)
        in[k] = (fmi2ValueReference)strtoul(argv[4 + 2 * k], NULL, 10), values[k] = atof(argv[5 + 2 * k]);
    tunable = atol(argv[8]), tuned = atof(argv[9]);
    for (int k = 10; k < argc; k++) {
        const char *is = strchr(argv[k], '=') + 1;
        switch (argv[k][0]) {
        case 'i': way.inputs = *is; break;
        case 's': *(strncmp(argv[k], "step", 4) ? &way.start : &way.step) = atof(is); break;
        case 'a': way.adds_up = 1; break;
        case 'r': *(strncmp(argv[k], "reset", 5) ? &way.restores : &way.resets) = 1; break;
        case 't': *(strncmp(argv[k], "tunes", 5) ? &way.threads : &way.tunes) = 1; break;
        default: way.resources = *is ? is : NULL;
        }
    }
    pthread_t threads[THREADS];
    for (int k = 0; k < THREADS && way.threads; k++)
        pthread_create(&threads[k], NULL, in_thread, "in a thread");
    char *first = run(made("first"), 1);
    for (int k = 0; k < THREADS && way.threads; k++) {
        void *text;
        pthread_join(threads[k], &text);
        if (strcmp(first, text) != 0)
            return fprintf(stderr, "thread %d gets other numbers\n", k), 1;
        free(text);
    }
    fputs(first, stdout);
    free(first);
    return 0;
}

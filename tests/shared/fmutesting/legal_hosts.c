/* Hosts that do what the standard allows, each in its way; legal_hosts.py has the table of them. Every PERIOD what an FMU
gives is printed, one line an instant, and the first input changes its sign. Usage:
legal_hosts LIBRARY GUID RESOURCES OUTPUTS IN_1 VALUE_1 IN_2 VALUE_2 TUNABLE VALUE_1 VALUE_2 inputs=IN step=S ...
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
    char inputs; /* b, i, a: before, in or after initialization; s: start values in it and these after it;
                    l: start values until after the first step; n: and nothing is exchanged before that */
    double begins, step, lasts, of; /* before the run that is printed it runs so long, in steps of so much */
    int adds_up, resets, restores, tunes, threads;
} way = {'i', 0.0, 1e-3, 0.0, 1.0, 0, 0, 0, 0, 0};

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
static fmi2ValueReference tunable;
static double values[2], tuned[2];
static size_t count;
static const char *guid, *resources;
static int of_fmi3;

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
    fmi2Component one = fmu.instantiate(name, fmi2CoSimulation, guid, *resources ? resources : NULL, &callbacks, fmi2False, fmi2True);
    if (!one)
        exit(1);
    return one;
}

static void initialize(fmi2Component one)
{
    double starts[2];
    if (way.inputs == 'b')
        OK(fmu.set(one, in, 2, values));
    if (way.tunes)
        OK(fmu.set(one, &tunable, 1, &tuned[1]));
    OK(fmu.setup(one, fmi2False, 0.0, way.begins, fmi2False, 0.0));
    if (!of_fmi3) /* there the start time is given on entering */
        OK(fmu.enter(one));
    if (way.tunes)
        OK(fmu.set(one, &tunable, 1, &tuned[0]));
    if (way.inputs == 's' || way.inputs == 'l') {
        OK(fmu.get(one, in, 2, starts));
        OK(fmu.set(one, in, 2, starts));
    }
    if (way.inputs == 'i')
        OK(fmu.set(one, in, 2, values));
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

/* The time of a host that counts its steps, or adds them up. */
static double next(double time, double start, double step, long made)
{
    return way.adds_up ? time + step : start + (double)made * step;
}

static char *run(fmi2Component one, int first)
{
    char *text = calloc(1, 1 << 16), *end = text;
    double y[MOST], time = way.begins, now[2] = {values[0], values[1]};
    const long each = lround(PERIOD / way.step), steps = lround(DURATION / way.step);
    initialize(one);
    for (long k = 0; k < lround(way.lasts / way.of); k++) {
        OK(fmu.step(one, time, way.of, fmi2True));
        time = next(time, way.begins, way.of, k + 1);
    }
    const double start = time;
    for (long k = 0; k <= steps; k++) {
        const int instant = k % each == 0;
        if (instant && (k > 0 || way.inputs != 'n')) {
            OK(fmu.get(one, outputs, count, y));
            for (size_t n = 0; n < count; n++)
                end += sprintf(end, "%.17g ", y[n]);
            end += sprintf(end, "\n");
            now[0] = k > 0 ? -now[0] : now[0];
        }
        if (instant && way.restores)
            one = restored(one);
        if (instant && way.tunes)
            OK(fmu.set(one, &tunable, 1, &tuned[k / each % 2]));
        if (k == steps)
            break;
        if (k > 0 && (instant || k == 1))
            OK(fmu.set(one, in, 2, now));
        OK(fmu.step(one, time, way.step, fmi2True));
        time = next(time, start, way.step, k + 1);
    }
    OK(fmu.terminate(one));
    if (way.resets && first) {
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
    of_fmi3 = dlsym(library, "fmi3DoStep") != NULL;
    guid = argv[2], resources = argv[3];
    for (char *text = argv[4]; *text && count < MOST; text += *text == ',')
        outputs[count++] = (fmi2ValueReference)strtoul(text, &text, 10);
    for (int k = 0; k < 2; k++) {
        in[k] = (fmi2ValueReference)strtoul(argv[5 + 2 * k], NULL, 10), values[k] = atof(argv[6 + 2 * k]);
        tuned[k] = atof(argv[10 + k]);
    }
    tunable = (fmi2ValueReference)strtoul(argv[9], NULL, 10);
    for (int k = 12; k < argc; k++) {
        const char *is = strchr(argv[k], '=') + 1;
        switch (argv[k][0]) {
        case 'i': way.inputs = *is; break;
        case 'b': way.begins = atof(is); break;
        case 's': way.step = atof(is); break;
        case 'l': way.lasts = atof(is); break;
        case 'o': way.of = atof(is); break;
        case 'a': way.adds_up = 1; break;
        case 'r': *(strncmp(argv[k], "reset", 5) ? &way.restores : &way.resets) = 1; break;
        default: *(strncmp(argv[k], "tunes", 5) ? &way.threads : &way.tunes) = 1;
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

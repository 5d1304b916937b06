/* A host without Python: loads an FMU, runs it, saves and restores it, resets it and runs it again.

usage: host LIBRARY GUID RESOURCES STEPS STEP_SIZE INPUT OUTPUT...
INPUT and OUTPUT are value references of Reals. Prints a line with the outputs of every communication point,
then `again` and those of a second run, of another load of the library. */
#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2FunctionTypes.h"

enum { MOST_OUTPUTS = 32 };

typedef struct {
    double step_size;
    int steps;
    fmi2ValueReference input;
    fmi2ValueReference outputs[MOST_OUTPUTS];
    size_t count;
} Run;

#define EACH(F)                                                                                             \
    F(Instantiate) F(FreeInstance) F(SetupExperiment) F(EnterInitializationMode) F(ExitInitializationMode)  \
    F(SetReal) F(GetReal) F(DoStep) F(Terminate) F(Reset) F(GetFMUstate) F(SetFMUstate) F(FreeFMUstate)

#define MEMBER(function) fmi2##function##TYPE *function;
typedef struct {
    EACH(MEMBER)
} Functions;

static void demand(int holds, const char *what)
{
    if (!holds) {
        fprintf(stderr, "failed: %s\n", what);
        exit(1);
    }
}

#define ok(call) demand((call) == fmi2OK, #call)

static void to_stderr(
    fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category, fmi2String message, ...)
{
    va_list arguments;
    (void)environment;
    fprintf(stderr, "%s, %d, %s: ", name, (int)status, category);
    va_start(arguments, message);
    vfprintf(stderr, message, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

static void find(void *library, const char *name, void *function)
{
    void *found = dlsym(library, name);
    demand(found != NULL, name);
    memcpy(function, &found, sizeof found);
}

static Functions functions_of(void *library)
{
    Functions f;
#define FOUND(function) find(library, "fmi2" #function, &f.function);
    EACH(FOUND)
    return f;
}

static void initialize(const Functions *f, fmi2Component c)
{
    ok(f->SetupExperiment(c, fmi2False, 0.0, 0.0, fmi2False, 0.0));
    ok(f->EnterInitializationMode(c));
    ok(f->ExitInitializationMode(c));
}

/* The steps first to last - 1; the input goes to and fro between 40 and -40. */
static void make_steps(const Functions *f, fmi2Component c, const Run *run, int first, int last)
{
    for (int k = first; k < last; k++) {
        const fmi2Real value = k / 50 % 2 ? -40.0 : 40.0;
        ok(f->SetReal(c, &run->input, 1, &value));
        ok(f->DoStep(c, k * run->step_size, run->step_size, fmi2True));
    }
}

static void get_outputs(const Functions *f, fmi2Component c, const Run *run, fmi2Real values[])
{
    ok(f->GetReal(c, run->outputs, run->count, values));
}

static void print_run(const Functions *f, fmi2Component c, const Run *run)
{
    fmi2Real values[MOST_OUTPUTS];
    for (int k = 0; k <= run->steps; k++) {
        get_outputs(f, c, run, values);
        for (size_t n = 0; n < run->count; n++)
            printf("%.17g ", values[n]);
        putchar('\n');
        if (k < run->steps)
            make_steps(f, c, run, k, k + 1);
    }
}

/* From a saved state on the second half of the run ends as it did before. */
static void check_saved_state(const Functions *f, fmi2Component c, const Run *run)
{
    const int half = run->steps / 2;
    fmi2FMUstate state = NULL;
    fmi2Real first[MOST_OUTPUTS], second[MOST_OUTPUTS];
    make_steps(f, c, run, 0, half);
    ok(f->GetFMUstate(c, &state));
    make_steps(f, c, run, half, run->steps);
    get_outputs(f, c, run, first);
    ok(f->SetFMUstate(c, state));
    ok(f->FreeFMUstate(c, &state));
    make_steps(f, c, run, half, run->steps);
    get_outputs(f, c, run, second);
    demand(memcmp(first, second, run->count * sizeof *first) == 0, "the run after a restore is the same");
}

static void load_and_run(char *const arguments[], const Run *run)
{
    const fmi2CallbackFunctions callbacks = {to_stderr, calloc, free, NULL, NULL};
    void *library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
    demand(library != NULL, dlerror());
    const Functions f = functions_of(library);
    const char *guid = arguments[2], *resources = arguments[3];
    fmi2Component c = f.Instantiate("one", fmi2CoSimulation, guid, resources, &callbacks, fmi2False, fmi2True);
    fmi2Component other = f.Instantiate("other", fmi2CoSimulation, guid, resources, &callbacks, fmi2False, fmi2True);
    demand(c && other, "fmi2Instantiate");
    initialize(&f, c);
    initialize(&f, other);
    make_steps(&f, other, run, 0, 10);
    print_run(&f, c, run);
    ok(f.Terminate(c));
    ok(f.Reset(c));
    initialize(&f, c);
    check_saved_state(&f, c, run);
    f.FreeInstance(c);
    make_steps(&f, other, run, 10, 20);
    f.FreeInstance(other);
    demand(dlclose(library) == 0, "dlclose");
}

int main(int count, char *arguments[])
{
    demand(count > 7 && count - 7 <= MOST_OUTPUTS, "usage: host LIBRARY GUID RESOURCES STEPS STEP_SIZE INPUT OUTPUT...");
    Run run = {.steps = atoi(arguments[4]), .step_size = atof(arguments[5]), .count = (size_t)(count - 7)};
    run.input = (fmi2ValueReference)atoi(arguments[6]);
    for (size_t k = 0; k < run.count; k++)
        run.outputs[k] = (fmi2ValueReference)atoi(arguments[7 + k]);
    load_and_run(arguments, &run);
    puts("again");
    load_and_run(arguments, &run);
    return 0;
}

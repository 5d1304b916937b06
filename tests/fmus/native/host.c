/* A host without Python: loads an FMU, runs it, saves and restores it, resets it and runs it again.

usage: host LIBRARY GUID STEPS STEP_SIZE INPUT OUTPUT...
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

typedef struct {
    fmi2SetupExperimentTYPE *setup_experiment;
    fmi2EnterInitializationModeTYPE *enter_initialization_mode;
    fmi2ExitInitializationModeTYPE *exit_initialization_mode;
    fmi2SetRealTYPE *set_real;
    fmi2GetRealTYPE *get_real;
    fmi2DoStepTYPE *do_step;
    fmi2TerminateTYPE *terminate;
    fmi2ResetTYPE *reset;
    fmi2GetFMUstateTYPE *get_state;
    fmi2SetFMUstateTYPE *set_state;
    fmi2FreeFMUstateTYPE *free_state;
    fmi2InstantiateTYPE *instantiate;
    fmi2FreeInstanceTYPE *free_instance;
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
    find(library, "fmi2Instantiate", &f.instantiate);
    find(library, "fmi2FreeInstance", &f.free_instance);
    find(library, "fmi2SetupExperiment", &f.setup_experiment);
    find(library, "fmi2EnterInitializationMode", &f.enter_initialization_mode);
    find(library, "fmi2ExitInitializationMode", &f.exit_initialization_mode);
    find(library, "fmi2SetReal", &f.set_real);
    find(library, "fmi2GetReal", &f.get_real);
    find(library, "fmi2DoStep", &f.do_step);
    find(library, "fmi2Terminate", &f.terminate);
    find(library, "fmi2Reset", &f.reset);
    find(library, "fmi2GetFMUstate", &f.get_state);
    find(library, "fmi2SetFMUstate", &f.set_state);
    find(library, "fmi2FreeFMUstate", &f.free_state);
    return f;
}

static void initialize(const Functions *f, fmi2Component c)
{
    ok(f->setup_experiment(c, fmi2False, 0.0, 0.0, fmi2False, 0.0));
    ok(f->enter_initialization_mode(c));
    ok(f->exit_initialization_mode(c));
}

/* The steps first to last - 1; the input goes to and fro between 40 and -40. */
static void make_steps(const Functions *f, fmi2Component c, const Run *run, int first, int last)
{
    for (int k = first; k < last; k++) {
        const fmi2Real value = k / 50 % 2 ? -40.0 : 40.0;
        ok(f->set_real(c, &run->input, 1, &value));
        ok(f->do_step(c, k * run->step_size, run->step_size, fmi2True));
    }
}

static void get_outputs(const Functions *f, fmi2Component c, const Run *run, fmi2Real values[])
{
    ok(f->get_real(c, run->outputs, run->count, values));
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
    ok(f->get_state(c, &state));
    make_steps(f, c, run, half, run->steps);
    get_outputs(f, c, run, first);
    ok(f->set_state(c, state));
    ok(f->free_state(c, &state));
    demand(state == NULL, "a freed state is NULL");
    make_steps(f, c, run, half, run->steps);
    get_outputs(f, c, run, second);
    demand(memcmp(first, second, run->count * sizeof *first) == 0, "the run after a restore is the same");
}

static void load_and_run(const char *path, const char *guid, const Run *run)
{
    const fmi2CallbackFunctions callbacks = {to_stderr, calloc, free, NULL, NULL};
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    demand(library != NULL, dlerror());
    const Functions f = functions_of(library);
    fmi2Component c = f.instantiate("one", fmi2CoSimulation, guid, "", &callbacks, fmi2False, fmi2True);
    fmi2Component other = f.instantiate("other", fmi2CoSimulation, guid, "", &callbacks, fmi2False, fmi2True);
    demand(c && other, "fmi2Instantiate");
    initialize(&f, c);
    initialize(&f, other);
    make_steps(&f, other, run, 0, 10);
    print_run(&f, c, run);
    ok(f.terminate(c));
    ok(f.reset(c));
    initialize(&f, c);
    check_saved_state(&f, c, run);
    f.free_instance(c);
    make_steps(&f, other, run, 10, 20);
    f.free_instance(other);
    demand(dlclose(library) == 0, "dlclose");
}

int main(int count, char *arguments[])
{
    demand(count > 6 && count - 6 <= MOST_OUTPUTS, "usage: host LIBRARY GUID STEPS STEP_SIZE INPUT OUTPUT...");
    Run run = {.steps = atoi(arguments[3]), .step_size = atof(arguments[4]), .count = (size_t)(count - 6)};
    run.input = (fmi2ValueReference)atoi(arguments[5]);
    for (size_t k = 0; k < run.count; k++)
        run.outputs[k] = (fmi2ValueReference)atoi(arguments[6 + k]);
    load_and_run(arguments[1], arguments[2], &run);
    puts("again");
    load_and_run(arguments[1], arguments[2], &run);
    return 0;
}

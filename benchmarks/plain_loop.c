/* The loop with nothing around the FMI functions: what no master can undercut. wiring.h is written by plain_loop.py.
 * Arguments: number of steps, step size in s. Prints processor time a step in s, and the watched Real. */
#define _POSIX_C_SOURCE 200112L

#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { FMI2_WARNING = 1, FMI2_CO_SIMULATION = 1, MOST = 16 };

typedef enum { REAL, INTEGER, BOOLEAN } Kind;

typedef struct {
    const char *library, *name, *guid, *resources;
    void *component, *code;
    int32_t (*do_step)(void *component, double time, double step_size, int32_t no_set_before);
} Fmu;

/* Values of one kind of an FMU; their places are in reals, or in wholes for the other kinds. */
typedef struct {
    size_t fmu, count;
    Kind kind;
    uint32_t references[MOST];
    size_t places[MOST];
    int32_t (*access)(void *component, const uint32_t *references, size_t count, void *values);
} Port;

typedef struct {
    size_t fmu;
    uint32_t reference;
    double value;
} Start;

#include "wiring.h" /* fmus, starts; inputs; outputs, whose places follow one another; WATCHED */

enum { FMUS = sizeof fmus / sizeof *fmus, STARTS = sizeof starts / sizeof *starts };
enum { INPUTS = sizeof inputs / sizeof *inputs, OUTPUTS = sizeof outputs / sizeof *outputs };

static double reals[OUTPUTS * MOST];
static int32_t wholes[OUTPUTS * MOST];

static void check(int32_t status, const char *what)
{
    if (status > FMI2_WARNING) {
        fprintf(stderr, "%s answered %d\n", what, (int)status);
        exit(1);
    }
}

/* ISO C has no conversion of an object pointer to one to a function: POSIX has it done like this. */
static void find(const Fmu *fmu, const char *name, void *function)
{
    *(void **)function = dlsym(fmu->code, name);
    check(*(void **)function ? 0 : 3, name);
}

static void call(const Fmu *fmu, const char *name)
{
    int32_t (*function)(void *);
    find(fmu, name, &function);
    check(function(fmu->component), name);
}

static void ignore(void *environment, const char *name, int32_t status, const char *category, const char *text, ...)
{
    (void)environment, (void)name, (void)status, (void)category, (void)text;
}

static void instantiate(Fmu *fmu)
{
    static const struct {
        void (*log)(void *, const char *, int32_t, const char *, const char *, ...);
        void *(*allocate)(size_t, size_t);
        void (*release)(void *);
        void (*finished)(void *, int32_t);
        void *environment;
    } callbacks = {ignore, calloc, free, NULL, NULL};
    void *(*function)(const char *, int, const char *, const char *, const void *, int32_t, int32_t);
    fmu->code = dlopen(fmu->library, RTLD_NOW | RTLD_LOCAL);
    check(fmu->code ? 0 : 3, fmu->library);
    find(fmu, "fmi2Instantiate", &function);
    fmu->component = function(fmu->name, FMI2_CO_SIMULATION, fmu->guid, fmu->resources, &callbacks, 0, 0);
    check(fmu->component ? 0 : 3, fmu->name);
    find(fmu, "fmi2DoStep", &fmu->do_step);
}

static void set_up(Fmu *fmu, double stop)
{
    int32_t (*function)(void *, int32_t, double, double, int32_t, double);
    find(fmu, "fmi2SetupExperiment", &function);
    check(function(fmu->component, 0, 0.0, 0.0, 1, stop), "fmi2SetupExperiment");
    call(fmu, "fmi2EnterInitializationMode");
}

static void start(const Start *given)
{
    int32_t (*function)(void *, const uint32_t *, size_t, const double *);
    find(&fmus[given->fmu], "fmi2SetReal", &function);
    check(function(fmus[given->fmu].component, &given->reference, 1, &given->value), "fmi2SetReal");
}

static void set(const Port *port)
{
    double real[MOST];
    int32_t whole[MOST];
    for (size_t i = 0; i < port->count; i++) {
        if (port->kind == REAL)
            real[i] = reals[port->places[i]];
        else
            whole[i] = wholes[port->places[i]];
    }
    void *values = port->kind == REAL ? (void *)real : (void *)whole;
    check(port->access(fmus[port->fmu].component, port->references, port->count, values), "fmi2Set");
}

static void get(const Port *port)
{
    void *values = port->kind == REAL ? (void *)&reals[port->places[0]] : (void *)&wholes[port->places[0]];
    check(port->access(fmus[port->fmu].component, port->references, port->count, values), "fmi2Get");
}

static void prepare(double stop)
{
    static const char *const setters[] = {"fmi2SetReal", "fmi2SetInteger", "fmi2SetBoolean"};
    static const char *const getters[] = {"fmi2GetReal", "fmi2GetInteger", "fmi2GetBoolean"};
    for (size_t i = 0; i < FMUS; i++)
        instantiate(&fmus[i]);
    for (size_t i = 0; i < INPUTS; i++)
        find(&fmus[inputs[i].fmu], setters[inputs[i].kind], &inputs[i].access);
    for (size_t i = 0; i < OUTPUTS; i++)
        find(&fmus[outputs[i].fmu], getters[outputs[i].kind], &outputs[i].access);
    for (size_t i = 0; i < STARTS; i++)
        start(&starts[i]);
    for (size_t i = 0; i < FMUS; i++)
        set_up(&fmus[i], stop);
    /* each round settles at least one connection: there is no algebraic loop */
    for (size_t round = 0; round < INPUTS * MOST; round++) {
        for (size_t i = 0; i < OUTPUTS; i++)
            get(&outputs[i]);
        for (size_t i = 0; i < INPUTS; i++)
            set(&inputs[i]);
    }
    for (size_t i = 0; i < FMUS; i++)
        call(&fmus[i], "fmi2ExitInitializationMode");
}

int main(int count, char **arguments)
{
    if (count != 3)
        return 1;
    long steps = atol(arguments[1]);
    double step_size = atof(arguments[2]);
    prepare((double)steps * step_size);
    clock_t began = clock();
    for (long k = 0; k < steps; k++) {
        for (size_t i = 0; i < INPUTS; i++)
            set(&inputs[i]);
        for (size_t i = 0; i < FMUS; i++)
            check(fmus[i].do_step(fmus[i].component, (double)k * step_size, step_size, 1), fmus[i].name);
        for (size_t i = 0; i < OUTPUTS; i++)
            get(&outputs[i]);
    }
    double took = (double)(clock() - began) / CLOCKS_PER_SEC;
    printf("%.17g %.17g\n", took / (double)steps, reals[WATCHED]);
    for (size_t i = 0; i < FMUS; i++)
        call(&fmus[i], "fmi2Terminate");
    return 0;
}

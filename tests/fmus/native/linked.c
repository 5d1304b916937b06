/* A program that FMUs are linked into: runs one instance of each, side by side, and prints their first outputs.

Compiled with EACH(X), which is X(name) for each FMU. Usage: linked GUID..., one for each; prints name and value. */
#include "fmi2FunctionTypes.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct {
    const char *name;
    fmi2InstantiateTYPE *instantiate;
    fmi2SetupExperimentTYPE *setup_experiment;
    fmi2EnterInitializationModeTYPE *enter_initialization_mode;
    fmi2ExitInitializationModeTYPE *exit_initialization_mode;
    fmi2SetRealTYPE *set_real;
    fmi2DoStepTYPE *do_step;
    fmi2GetRealTYPE *get_real;
    fmi2TerminateTYPE *terminate;
    fmi2FreeInstanceTYPE *free_instance;
    fmi2ValueReference output;
} Fmu;

#define DECLARED(name, output)                                            \
    extern fmi2InstantiateTYPE name##_fmi2Instantiate;                    \
    extern fmi2SetupExperimentTYPE name##_fmi2SetupExperiment;            \
    extern fmi2EnterInitializationModeTYPE name##_fmi2EnterInitializationMode; \
    extern fmi2ExitInitializationModeTYPE name##_fmi2ExitInitializationMode; \
    extern fmi2SetRealTYPE name##_fmi2SetReal;                            \
    extern fmi2DoStepTYPE name##_fmi2DoStep;                              \
    extern fmi2GetRealTYPE name##_fmi2GetReal;                            \
    extern fmi2TerminateTYPE name##_fmi2Terminate;                        \
    extern fmi2FreeInstanceTYPE name##_fmi2FreeInstance;
EACH(DECLARED)

#define LISTED(name, output)                 \
    {#name,                                  \
     name##_fmi2Instantiate,                 \
     name##_fmi2SetupExperiment,             \
     name##_fmi2EnterInitializationMode,     \
     name##_fmi2ExitInitializationMode,      \
     name##_fmi2SetReal,                     \
     name##_fmi2DoStep,                      \
     name##_fmi2GetReal,                     \
     name##_fmi2Terminate,                   \
     name##_fmi2FreeInstance,                \
     output},
static const Fmu fmus[] = {EACH(LISTED)};

enum { COUNT = sizeof fmus / sizeof *fmus, STEPS = 100 };

static void demand(fmi2Status status, const Fmu *fmu, const char *what)
{
    if (status != fmi2OK) {
        fprintf(stderr, "%s: %s\n", fmu->name, what);
        exit(1);
    }
}

int main(int count, char *arguments[])
{
    const fmi2CallbackFunctions callbacks = {NULL, calloc, free, NULL, NULL};
    const fmi2ValueReference input = 0;
    const fmi2Real torque = 40.0;
    fmi2Component instances[COUNT];
    if (count != COUNT + 1)
        return 2;
    for (int n = 0; n < COUNT; n++) {
        const Fmu *fmu = &fmus[n];
        instances[n] = fmu->instantiate(fmu->name, fmi2CoSimulation, arguments[1 + n], NULL, &callbacks, 0, 0);
        demand(instances[n] ? fmi2OK : fmi2Error, fmu, "instantiate");
        demand(fmu->setup_experiment(instances[n], 0, 0.0, 0.0, 0, 0.0), fmu, "setup");
        demand(fmu->enter_initialization_mode(instances[n]), fmu, "enter");
        demand(fmu->exit_initialization_mode(instances[n]), fmu, "exit");
        demand(fmu->set_real(instances[n], &input, 1, &torque), fmu, "set");
    }
    for (int k = 0; k < STEPS; k++)
        for (int n = 0; n < COUNT; n++)
            demand(fmus[n].do_step(instances[n], k * 1e-3, 1e-3, 1), &fmus[n], "step");
    for (int n = 0; n < COUNT; n++) {
        fmi2Real value;
        demand(fmus[n].get_real(instances[n], &fmus[n].output, 1, &value), &fmus[n], "get");
        printf("%s %.17g\n", fmus[n].name, value);
        demand(fmus[n].terminate(instances[n]), &fmus[n], "terminate");
        fmus[n].free_instance(instances[n]);
    }
    return 0;
}

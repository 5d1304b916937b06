/* A program that FMUs are linked into: runs one instance of each, side by side, and prints their first outputs.

Compiled with EACH(X), which is X(name) for each FMU. Usage: linked GUID..., one for each; prints name and value. */
#include "fmi2FunctionTypes.h"

#include <stdio.h>
#include <stdlib.h>

#define FUNCTIONS(F, name)                                                                                \
    F(name, Instantiate) F(name, SetupExperiment) F(name, EnterInitializationMode)                        \
    F(name, ExitInitializationMode) F(name, SetReal) F(name, DoStep) F(name, GetReal) F(name, Terminate)  \
    F(name, FreeInstance)

#define MEMBER(name, function) fmi2##function##TYPE *function;
typedef struct {
    const char *name;
    FUNCTIONS(MEMBER, )
    fmi2ValueReference output;
} Fmu;

#define EXTERN(name, function) extern fmi2##function##TYPE name##_fmi2##function;
#define DECLARED(name, output) FUNCTIONS(EXTERN, name)
EACH(DECLARED)

#define POINTER(name, function) name##_fmi2##function,
#define LISTED(name, output) {#name, FUNCTIONS(POINTER, name) output},
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
        instances[n] = fmu->Instantiate(fmu->name, fmi2CoSimulation, arguments[1 + n], NULL, &callbacks, 0, 0);
        demand(instances[n] ? fmi2OK : fmi2Error, fmu, "instantiate");
        demand(fmu->SetupExperiment(instances[n], 0, 0.0, 0.0, 0, 0.0), fmu, "setup");
        demand(fmu->EnterInitializationMode(instances[n]), fmu, "enter");
        demand(fmu->ExitInitializationMode(instances[n]), fmu, "exit");
        demand(fmu->SetReal(instances[n], &input, 1, &torque), fmu, "set");
    }
    for (int k = 0; k < STEPS; k++)
        for (int n = 0; n < COUNT; n++)
            demand(fmus[n].DoStep(instances[n], k * 1e-3, 1e-3, 1), &fmus[n], "step");
    for (int n = 0; n < COUNT; n++) {
        fmi2Real value;
        demand(fmus[n].GetReal(instances[n], &fmus[n].output, 1, &value), &fmus[n], "get");
        printf("%s %.17g\n", fmus[n].name, value);
        demand(fmus[n].Terminate(instances[n]), &fmus[n], "terminate");
        fmus[n].FreeInstance(instances[n]);
    }
    return 0;
}

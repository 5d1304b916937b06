/* A host that is not Python: makes an instance, lets it make steps, frees it and ends.

Usage: exit_host LIBRARY RESOURCES; started with libpython loaded before it. */
#include "fmi2FunctionTypes.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void write_message(
    fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category, fmi2String message, ...)
{
    (void)environment;
    fprintf(stderr, "%s, %d, %s: %s\n", name, (int)status, category, message);
}

static void *library;

static void find(const char *name, void *function)
{
    void *found = dlsym(library, name);
    if (!found)
        exit(1);
    memcpy(function, &found, sizeof found);
}

static void demand(fmi2Status status)
{
    if (status != fmi2OK)
        exit(2);
}

int main(int count, char *arguments[])
{
    const fmi2CallbackFunctions callbacks = {write_message, calloc, free, NULL, NULL};
    fmi2InstantiateTYPE *instantiate;
    fmi2SetupExperimentTYPE *setup_experiment;
    fmi2EnterInitializationModeTYPE *enter_initialization_mode;
    fmi2ExitInitializationModeTYPE *exit_initialization_mode;
    fmi2DoStepTYPE *do_step;
    fmi2FreeInstanceTYPE *free_instance;
    library = count == 3 ? dlopen(arguments[1], RTLD_NOW) : NULL;
    if (!library)
        return 3;
    find("fmi2Instantiate", &instantiate);
    find("fmi2SetupExperiment", &setup_experiment);
    find("fmi2EnterInitializationMode", &enter_initialization_mode);
    find("fmi2ExitInitializationMode", &exit_initialization_mode);
    find("fmi2DoStep", &do_step);
    find("fmi2FreeInstance", &free_instance);
    for (int round = 0; round < 2; round++) {
        fmi2Component c = instantiate("one", fmi2CoSimulation, "", arguments[2], &callbacks, fmi2False, fmi2True);
        if (!c)
            return 4;
        demand(setup_experiment(c, fmi2False, 0.0, 0.0, fmi2False, 0.0));
        demand(enter_initialization_mode(c));
        demand(exit_initialization_mode(c));
        for (int k = 0; k < 3; k++)
            demand(do_step(c, k * 1e-3, 1e-3, fmi2True));
        free_instance(c);
    }
    puts("done");
    return 0;
}

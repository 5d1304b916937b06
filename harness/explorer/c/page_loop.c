/* Loops of FMUs that are linked into one module, for a page: tables.h has the FMUs and the calls of each loop, steps.c,
which is that of the master, makes them. The page fills in time and inputs, and reads the table. */
#include "callbacks.h"

#include "steps.c"

#include <stdio.h>

typedef struct {
    const char *guid;
    fmi2InstantiateTYPE *instantiate;
    fmi2SetupExperimentTYPE *set_up;
    fmi2EnterInitializationModeTYPE *enter;
    fmi2ExitInitializationModeTYPE *leave;
    fmi2ResetTYPE *reset;
    fmi2FreeInstanceTYPE *release;
    fmi2SetRealTYPE *set_real;
    fmi2SetIntegerTYPE *set_integer;
    fmi2SetBooleanTYPE *set_boolean;
    fmi2SetContinuousStatesTYPE *set_states; /* null: no model exchange */
    fmi2GetContinuousStatesTYPE *get_states;
    fmi2GetDerivativesTYPE *get_rates;
    fmi2NewDiscreteStatesTYPE *discrete;
    fmi2EnterContinuousTimeModeTYPE *integrate;
} Fmu;

typedef struct {
    const uint32_t *fmus; /* their numbers, in the order in which they step */
    uint32_t count;
    Call *calls;          /* of a step */
    size_t turn, number;  /* those before time goes on, and all */
    Call *hand_over;      /* bring outputs to inputs */
    size_t handed;
    unsigned char *row;   /* the instant at work, and behind its columns output derivatives */
    size_t known, size, whole; /* bytes of the row: known in advance, of a column in the table, all */
} Loop;

static double step_size;
static double table[ROWS * MOST_BYTES / sizeof(double)];

#include "tables.h"

static fmi2Component components[sizeof fmus / sizeof *fmus];
static struct call_record record;

KEPT void *rows(void)
{
    return table;
}

/* Brings the FMUs of a loop to where parameters can be set. */
KEPT fmi2Status begin(uint32_t number)
{
    const Loop *loop = &loops[number];
    call_record = &record;
    message[0] = '\0';
    for (uint32_t k = 0; k < loop->count; k++) {
        const Fmu *fmu = &fmus[loop->fmus[k]];
        fmi2Component *component = &components[loop->fmus[k]];
        if (*component && fmu->reset(*component) != fmi2OK)
            return fmi2Error;
        if (!*component) { /* the second: the first is for tools of calibration, and looks in every step what they wrote */
            fmu->instantiate("first", fmi2CoSimulation, fmu->guid, "", &callbacks, 0, 1);
            *component = fmu->instantiate("page", fmi2CoSimulation, fmu->guid, "", &callbacks, 0, 1);
        }
        if (!*component)
            return fmi2Error;
    }
    for (size_t k = 0; k < loop->number; k++)
        loop->calls[k].component = components[loop->fmus[loop->calls[k].instance]];
    for (size_t k = 0; k < loop->handed; k++)
        loop->hand_over[k].component = components[loop->fmus[loop->hand_over[k].instance]];
    return fmi2OK;
}

static fmi2Status set_in(const Fmu *fmu, fmi2Component component, int type, fmi2ValueReference reference, double value)
{
    const int whole_value = (int)value;
    switch (type) {
    case 0:
        return fmu->set_real(component, &reference, 1, &value);
    case 1:
        return fmu->set_integer(component, &reference, 1, &whole_value);
    default:
        return fmu->set_boolean(component, &reference, 1, &whole_value);
    }
}

/* Sets a parameter: 0 Real, 1 Integer, 2 Boolean. */
KEPT fmi2Status set(uint32_t number, uint32_t instance, int type, fmi2ValueReference reference, double value)
{
    const uint32_t fmu = loops[number].fmus[instance];
    return set_in(&fmus[fmu], components[fmu], type, reference, value);
}

/* From the parameters to the first step: outputs go to inputs until nothing changes, from what is known in the first
row of the table to all of that row. */
KEPT fmi2Status start_run(uint32_t number, double stop, double size)
{
    const Loop *loop = &loops[number];
    unsigned char before[2 * MOST_BYTES];
    step_size = size;
    for (uint32_t k = 0; k < loop->count; k++) {
        const Fmu *fmu = &fmus[loop->fmus[k]];
        const fmi2Component component = components[loop->fmus[k]];
        if (fmu->set_up(component, 0, 0.0, 0.0, 1, stop) != fmi2OK || fmu->enter(component) != fmi2OK)
            return fmi2Error;
    }
    memset(loop->row, 0, loop->whole);
    memcpy(loop->row, table, loop->known);
    int settled = 0;
    for (size_t round = 0; round < MOST_ROUNDS && !settled; round++) {
        memcpy(before, loop->row, loop->whole);
        for (size_t k = 0; k < loop->handed; k++) {
            const Call *call = &loop->hand_over[k];
            if (call->sources)
                changed(call, loop->row);
            const int32_t status = exchange(call);
            if (status != fmi2OK && status != fmi2Warning)
                return fmi2Error;
        }
        settled = round > 0 && memcmp(before, loop->row, loop->whole) == 0;
    }
    memcpy(table, loop->row, loop->size);
    for (uint32_t k = 0; settled && k < loop->count; k++)
        if (fmus[loop->fmus[k]].leave(components[loop->fmus[k]]) != fmi2OK)
            return fmi2Error;
    return settled ? fmi2OK : fmi2Error;
}

/* Makes steps from the first row of the table on, in which time and inputs of all rows are, and then brings the last
row to its beginning. Returns how many were made. */
KEPT size_t run_steps(uint32_t number, size_t count)
{
    const Loop *loop = &loops[number];
    size_t refused;
    int32_t status = OK;
    unsigned char *bytes = (unsigned char *)table;
    const size_t made_steps = make_steps(
        loop->calls, loop->turn, loop->number, loop->row, loop->known, bytes, loop->size, 0, count, &refused, &status);
    if (status == NOT_FINITE)
        snprintf(message, sizeof message, "an output is not finite");
    return made_steps;
}

#include "page_mode.c"

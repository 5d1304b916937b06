/* Event mode, binary variables and clocks of an FMU of FMI 3.0 with a terminal; the rest of fmi3.c.

Tx_Clock is active in event mode while there is something to be sent, however often it is asked for, until
fmi3UpdateDiscreteStates (FMI 3.0.2, section 2.3.5; in scheduled execution alone does asking deactivate a clock). */
#include "fmi3Functions.h"
#include "instance.h"

#include <string.h>

static fmi3Status refuse_of_terminal(Instance *instance, Reference reference, const char *function, const char *type)
{
    if (reference < TX_DATA || reference > RX_CLOCK)
        return no_variable(instance, &reference, 1, function, type);
    const int is_clock = reference == TX_CLOCK || reference == RX_CLOCK;
    return in_fmi3(refuse(instance, WRONG_TYPE(terminal_names[reference - TX_DATA], is_clock ? "Clock" : "Binary", type)));
}

fmi3Status fmi3GetBinary(
    fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, size_t valueSizes[], fmi3Binary values[],
    size_t nValues)
{
    Instance *instance = ready(c, ANY_MODE, nvr == 0 || (vr && valueSizes && values), __func__);
    if (!instance || !is_count(instance, nValues, nvr, __func__))
        return fmi3Error;
    const Terminal *terminal = &instance->memory.terminal;
    for (size_t k = 0; k < nvr; k++) {
        if (vr[k] != TX_DATA && vr[k] != RX_DATA)
            return refuse_of_terminal(instance, vr[k], __func__, "Binary");
        values[k] = vr[k] == TX_DATA ? terminal->tx : terminal->rx;
        valueSizes[k] = vr[k] == RX_DATA ? terminal->rx_size : instance->memory.mode == EVENT ? terminal->tx_size : 0;
    }
    return fmi3OK;
}

fmi3Status fmi3SetBinary(
    fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const size_t valueSizes[], const fmi3Binary values[],
    size_t nValues)
{
    const unsigned modes = INSTANTIATED | INITIALIZATION | EVENT;
    Instance *instance = ready(c, modes, nvr == 0 || (vr && valueSizes && values), __func__);
    if (!instance || !is_count(instance, nValues, nvr, __func__))
        return fmi3Error;
    Terminal *terminal = &instance->memory.terminal;
    for (size_t k = 0; k < nvr; k++) {
        const unsigned long size = (unsigned long)valueSizes[k];
        if (vr[k] == TX_DATA)
            return in_fmi3(refuse(instance, OUTPUT_SET(terminal_names[0])));
        if (vr[k] != RX_DATA)
            return refuse_of_terminal(instance, vr[k], __func__, "Binary");
        if (size > OPERATIONS_SIZE || (size > 0 && !values[k]))
            return in_fmi3(refuse(
                instance, "%s with %lu bytes is refused; allowed are 0 to %d", terminal_names[RX_DATA - TX_DATA], size,
                OPERATIONS_SIZE));
    }
    for (size_t k = 0; k < nvr; k++) {
        terminal->rx_size = valueSizes[k];
        if (valueSizes[k])
            memmove(terminal->rx, values[k], valueSizes[k]); /* they may be those of fmi3GetBinary */
        memset(terminal->rx + valueSizes[k], 0, sizeof terminal->rx - valueSizes[k]);
    }
    return fmi3OK;
}

fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, fmi3Clock values[])
{
    Instance *instance = ready(c, ANY_MODE, nvr == 0 || (vr && values), __func__);
    if (!instance)
        return fmi3Error;
    const Terminal *terminal = &instance->memory.terminal;
    for (size_t k = 0; k < nvr; k++) {
        if (vr[k] != TX_CLOCK && vr[k] != RX_CLOCK)
            return refuse_of_terminal(instance, vr[k], __func__, "Clock");
        const int sends = instance->memory.mode == EVENT && terminal->tx_size > 0;
        values[k] = vr[k] == TX_CLOCK ? sends : terminal->has_rx != 0;
    }
    return fmi3OK;
}

fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr, const fmi3Clock values[])
{
    Instance *instance = ready(c, EVENT, nvr == 0 || (vr && values), __func__);
    if (!instance)
        return fmi3Error;
    for (size_t k = 0; k < nvr; k++)
        if (vr[k] == TX_CLOCK)
            return in_fmi3(refuse(instance, OUTPUT_SET(terminal_names[TX_CLOCK - TX_DATA])));
        else if (vr[k] != RX_CLOCK)
            return refuse_of_terminal(instance, vr[k], __func__, "Clock");
    for (size_t k = 0; k < nvr; k++)
        instance->memory.terminal.has_rx = values[k] != fmi3ClockInactive;
    return fmi3OK;
}

fmi3Status fmi3EnterEventMode(fmi3Instance c)
{
    Instance *instance = ready(c, STEPPING, 1, __func__);
    if (!instance)
        return fmi3Error;
    if (!instance->has_events)
        return in_fmi3(refuse(instance, "fmi3EnterEventMode is refused; the instance was made without event mode"));
    instance->memory.mode = EVENT;
    return fmi3OK;
}

CHANGE(fmi3EnterStepMode, EVENT, instance->memory.mode = STEPPING)

fmi3Status fmi3UpdateDiscreteStates(
    fmi3Instance c, fmi3Boolean *discreteStatesNeedUpdate, fmi3Boolean *terminateSimulation,
    fmi3Boolean *nominalsOfContinuousStatesChanged, fmi3Boolean *valuesOfContinuousStatesChanged,
    fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime)
{
    const int complete = discreteStatesNeedUpdate && terminateSimulation && nominalsOfContinuousStatesChanged &&
                         valuesOfContinuousStatesChanged && nextEventTimeDefined && nextEventTime;
    Instance *instance = ready(c, EVENT, complete, __func__);
    if (!instance)
        return fmi3Error;
    update_terminal(&instance->memory.terminal);
    *discreteStatesNeedUpdate = instance->memory.terminal.tx_size > 0; /* the answer to what has come in */
    *terminateSimulation = *nominalsOfContinuousStatesChanged = *valuesOfContinuousStatesChanged = fmi3False;
    *nextEventTimeDefined = fmi3False;
    *nextEventTime = 0.0;
    return fmi3OK;
}

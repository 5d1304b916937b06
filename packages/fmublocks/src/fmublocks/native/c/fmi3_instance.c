/* The adapter to FMI 3.0: instances, and what they tell their host. */
#include "fmi3Functions.h"
#include "instance.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An instance as the host has it. */
typedef struct {
    Instance instance;
    fmi3LogMessageCallback log_message;
    fmi3InstanceEnvironment environment;
} Component;

static void log_for(void *listener, Status status, const char *message)
{
    const Component *component = listener;
    if (component->log_message)
        component->log_message(component->environment, in_fmi3(status), category_of(status), message);
}

fmi3Status fmi3SetDebugLogging(
    fmi3Instance c, fmi3Boolean loggingOn, size_t nCategories, const fmi3String categories[])
{
    Instance *instance = ready(c, ANY_MODE, nCategories == 0 || categories, __func__);
    return instance ? in_fmi3(set_logging(instance, loggingOn, nCategories, categories)) : fmi3Error;
}

/* An instance that a host asks for. */
typedef struct {
    const char *function;
    fmi3String name;
    fmi3String token;
    const char *objection; /* why there is none of that kind; NULL: there is */
    fmi3Boolean logging;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log_message;
} Asked;

static void *refuse_instance(const Asked *asked, const char *why)
{
    char message[MESSAGE_LENGTH];
    snprintf(message, sizeof message, "%s: %s", asked->function, why);
    if (asked->log_message)
        asked->log_message(asked->environment, fmi3Error, category_of(ERROR), message);
    return NULL;
}

static Component *instantiate(const Asked *asked, Kind kind, int has_events)
{
    if (asked->objection)
        return refuse_instance(asked, asked->objection);
    if (!asked->name || !*asked->name)
        return refuse_instance(asked, "an instance needs a name");
    if (!asked->token || strcmp(asked->token, model_guid) != 0)
        return refuse_instance(asked, "the instantiation token is that of another FMU");
    Component *component = first_place(sizeof *component);
    if (!component)
        component = calloc(1, sizeof *component);
    if (!component)
        return refuse_instance(asked, "no memory");
    const Host host = {calloc, log_for, component, own_name, {0}};
    component->instance.host = host;
    component->instance.kind = kind;
    component->instance.has_events = has_events;
    component->log_message = asked->log_message;
    component->environment = asked->environment;
    set_logging(&component->instance, asked->logging, 0, NULL);
    renew(&component->instance);
    return component;
}

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath, fmi3Boolean visible,
    fmi3Boolean loggingOn, fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
    const fmi3ValueReference requiredIntermediateVariables[], size_t nRequiredIntermediateVariables,
    fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage,
    fmi3IntermediateUpdateCallback intermediateUpdate)
{
    (void)resourcePath;
    (void)visible;
    (void)earlyReturnAllowed; /* no step ends early */
    (void)requiredIntermediateVariables;
    (void)intermediateUpdate;
    const char *objection = eventModeUsed && !allows_event_mode ? "the FMU has no event mode"
                            : nRequiredIntermediateVariables    ? "the FMU has no intermediate update"
                                                                : NULL;
    const Asked asked = {
        __func__, instanceName, instantiationToken, objection, loggingOn, instanceEnvironment, logMessage};
    return instantiate(&asked, CO_SIMULATION, eventModeUsed);
}

fmi3Instance fmi3InstantiateModelExchange(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath, fmi3Boolean visible,
    fmi3Boolean loggingOn, fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage)
{
    (void)resourcePath;
    (void)visible;
    const char *objection = allows_model_exchange ? NULL : "the FMU has no model exchange";
    const Asked asked = {
        __func__, instanceName, instantiationToken, objection, loggingOn, instanceEnvironment, logMessage};
    return instantiate(&asked, MODEL_EXCHANGE, 0);
}

fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath, fmi3Boolean visible,
    fmi3Boolean loggingOn, fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage,
    fmi3ClockUpdateCallback clockUpdate, fmi3LockPreemptionCallback lockPreemption,
    fmi3UnlockPreemptionCallback unlockPreemption)
{
    (void)resourcePath;
    (void)visible;
    (void)clockUpdate;
    (void)lockPreemption;
    (void)unlockPreemption;
    const Asked asked = {
        __func__, instanceName, instantiationToken, "the FMU has no scheduled execution", loggingOn,
        instanceEnvironment, logMessage};
    return instantiate(&asked, CO_SIMULATION, 0);
}

void fmi3FreeInstance(fmi3Instance c)
{
    if (!left_first_place(c))
        free(c);
}

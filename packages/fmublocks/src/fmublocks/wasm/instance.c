/* What a host without function pointers makes instances with. */
#include "callbacks.h"

#include "fmi2Functions.h"

KEPT fmi2Component instantiate(fmi2String name, fmi2String guid, fmi2Boolean model_exchange);

fmi2Component instantiate(fmi2String name, fmi2String guid, fmi2Boolean model_exchange)
{
    message[0] = '\0';
    return fmi2Instantiate(
        name, model_exchange ? fmi2ModelExchange : fmi2CoSimulation, guid, "", &callbacks, fmi2False, fmi2True);
}

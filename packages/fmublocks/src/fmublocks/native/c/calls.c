/* What the adapters have in common: whether a call comes in its place, and which messages its host wants. */
#include "instance.h"

#include <string.h>

RARE static void refuse_call(const Instance *instance, unsigned modes, const char *function)
{
    if (instance && in_mode(instance, modes, function))
        refuse(instance, "%s: an argument is NULL", function);
}

/* The instance with which what an adapter gives out begins, if it is in one of the modes and the call is complete. */
inline Instance *ready(void *component, unsigned modes, int complete, const char *function)
{
    Instance *instance = component;
    if (instance && complete && ((unsigned)instance->memory.mode & modes))
        return instance;
    refuse_call(instance, modes, function);
    return NULL;
}

Instance *ready_for(Kind kind, void *component, unsigned modes, int complete, const char *function)
{
    const Instance *instance = component;
    if (!instance || instance->kind == kind)
        return ready(component, modes, complete, function);
    refuse(instance, "%s is refused; the instance was made for %s", function, kind_name(instance->kind));
    return NULL;
}

const char *category_of(Status status)
{
    static const char *const categories[] = {[OK] = "", [DISCARD] = LOG_DISCARD, [ERROR] = LOG_ERROR};
    return categories[status];
}

/* The status whose messages are of a category; OK if there is none. */
static Status status_of(const char *category)
{
    for (Status status = DISCARD; category && status <= ERROR; status++)
        if (strcmp(category, category_of(status)) == 0)
            return status;
    return OK;
}

Status set_logging(Instance *instance, int on, size_t count, const char *const categories[])
{
    int *logged = instance->host.logged;
    for (size_t k = 0; k < count; k++)
        if (status_of(categories[k]) == OK)
            return refuse(
                instance, "log category %s is unknown; there are " LOG_ERROR " and " LOG_DISCARD,
                categories[k] ? categories[k] : "NULL");
    for (size_t k = 0; k < count; k++)
        logged[status_of(categories[k])] = on;
    if (count == 0)
        logged[DISCARD] = logged[ERROR] = on;
    return OK;
}

int orders_are_one(const Instance *instance, const int orders[], size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (orders[k] != 1) {
            refuse(instance, "derivative of order %d is refused; allowed is 1", orders[k]);
            return 0;
        }
    return 1;
}

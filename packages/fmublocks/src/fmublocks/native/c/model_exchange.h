/* What model exchange asks of a continuous block: the host integrates. */
#ifndef MODEL_EXCHANGE_H
#define MODEL_EXCHANGE_H

#include "instance.h"

enum { INTEGRATING = EVENT | CONTINUOUS_TIME, READABLE = INITIALIZATION | INTEGRATING | TERMINATED };

/* All take or give as many numbers as there are states, or event indicators; else they refuse the count. */
static Status get_states(const Instance *instance, double x[], size_t count);
static Status set_states(Instance *instance, const double x[], size_t count); /* discards what is not finite */
static Status get_rates(const Instance *instance, double dx[], size_t count); /* their derivatives; likewise */
static Status get_nominals(const Instance *instance, double x_nominal[], size_t count);
static Status get_indicators(const Instance *instance, double z[], size_t count);

static Status set_time(Instance *instance, double time);

/* At an event: on which side of its zero each indicator is from here on. */
static void update_sides(Instance *instance);

/* When outputs jump by themselves, in s; infinite if they never do. */
static double next_event_time(const Instance *instance);

#endif

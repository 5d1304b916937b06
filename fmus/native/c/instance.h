/* One instance of the FMU. There is nothing outside instances, so several run side by side. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "block.h"
#include "fmi2Functions.h"
#include "variables.h"

#include <stdint.h>

#if defined __GNUC__
#pragma GCC visibility push(hidden)
#endif

/* Where an instance is in the sequence of calls. */
typedef enum { INSTANTIATED = 1, INITIALIZATION = 2, STEPPING = 4, TERMINATED = 8 } Mode;

/* All that a saved state holds; whole multiples of 8 bytes, so that it has no gaps. */
typedef struct {
    Values values;     /* the outputs in it are those of the present when outputs_known */
    Input du;          /* rates of change of the inputs during the next step */
    State x;           /* from the end of initialization mode on */
    State coming;      /* of a sampled block: what its last tick computed */
    double start_time; /* s */
    double time;       /* s */
    double ticks;      /* of a sampled block: ticks made */
    int64_t mode;
    int64_t moving;        /* whether du is not zero */
    int64_t outputs_known;
    int64_t last_step;     /* status of the last fmi2DoStep */
} Memory;

enum { LOG_ERROR, LOG_DISCARD, LOG_CATEGORIES };

typedef struct {
    fmi2CallbackFunctions callbacks;
    int logged[LOG_CATEGORIES];
    char *name;
    Memory memory;
} Instance;

/* messages.c */
enum { NUMBER_LENGTH = 40 };
char *write_number(char text[NUMBER_LENGTH], double value); /* as Python's repr */
fmi2Status refuse(const Instance *instance, const char *format, ...);  /* logs; fmi2Error */
fmi2Status discard(const Instance *instance, const char *format, ...); /* logs; fmi2Discard */
void log_without_instance(const fmi2CallbackFunctions *callbacks, fmi2String name, const char *message);
int category_of(const char *name); /* -1 for an unknown one */
int in_mode(const Instance *instance, unsigned modes, const char *function); /* else it is refused */

/* values.c */
void set_start_values(Memory *memory);
fmi2Status get_values(Instance *instance, Type type, const fmi2ValueReference references[], size_t count, void *values);
fmi2Status set_values(
    Instance *instance, Type type, const fmi2ValueReference references[], size_t count, const void *values);
const Variable *variable_of(const Instance *instance, fmi2ValueReference reference, Type type); /* NULL if refused */
double *place_of(Values *values, const Variable *variable);

/* continuous.c or sampled.c */
void advance(Memory *memory, double end, double duration);
fmi2Status check_moving_inputs(Instance *instance, double duration); /* refused if one leaves its range */
fmi2Status set_input_rates(
    Instance *instance, const fmi2ValueReference references[], size_t count, const fmi2Real rates[]);
fmi2Status get_output_rates(
    Instance *instance, const fmi2ValueReference references[], size_t count, fmi2Real rates[]);
fmi2Status get_directional_derivative(
    Instance *instance,
    const fmi2ValueReference unknown[],
    size_t unknowns,
    const fmi2ValueReference known[],
    size_t knowns,
    const fmi2Real change[],
    fmi2Real result[]);

#if defined __GNUC__
#pragma GCC visibility pop
#endif

#endif

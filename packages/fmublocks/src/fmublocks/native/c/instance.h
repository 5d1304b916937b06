/* One instance of a block at work, whatever standard its host speaks: an adapter translates.

There is nothing outside instances but the place of the first one, so several run side by side; and no function but
those of the adapter has a name outside the one file that is compiled, all.c, so FMUs can be linked with each other. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "block.h"
#include "shared.h"
#include "variables.h"

#ifdef TERMINAL
#include "terminal.h"
enum { allows_event_mode = 1 };
#else
enum { allows_event_mode = 0 };
#endif

#include <stdint.h>

/* How a call ended. Of a refused one the host was told why, and nothing has changed. */
typedef enum { OK, DISCARD, ERROR } Status; /* DISCARD: a step or question that the host can do without */

/* A variable's place in `variables`. */
typedef unsigned Reference;

/* Whether the host asks for steps, or integrates. */
typedef enum { CO_SIMULATION, MODEL_EXCHANGE } Kind;

enum { NAME_LENGTH = 100 };

/* What an instance needs of its host. */
typedef struct {
    void *(*allocate)(size_t count, size_t size); /* NULL if there is no memory */
    void (*log)(void *listener, Status status, const char *message);
    void *listener;
    /* Names a variable that the adapter has beside `variables`; 0 if there is none. NULL: it has none at all. */
    int (*name_of)(char name[NAME_LENGTH], Reference reference);
    int logged[ERROR + 1]; /* by status: whether it wants to be told */
} Host;

/* All that a saved state holds; whole multiples of 8 bytes, so that it has no gaps. */
typedef struct {
    Values values;     /* the outputs in it are those of the present when outputs_known */
    Input du;          /* rates of change of the inputs during a step; 0 if they are held */
    int64_t sides;     /* in model exchange: bit n is set where event indicator n counts as above its zero */
    State x;           /* from the end of initialization mode on */
    State coming;      /* of a sampled block: what its last tick computed */
    double start_time; /* s */
    double stop_time;  /* s; infinite if there is none */
    double time;       /* s */
    double to_tick;    /* of a sampled block: sample times to the next tick */
    int64_t mode;
    int64_t outputs_known;
    int64_t last_step;     /* status of the last step */
#ifdef TERMINAL
    Terminal terminal;
#endif
} Memory;

typedef struct {
    Memory memory; /* first: its address is that of the instance */
    Host host;
    Kind kind;
    int has_events; /* in co-simulation: the host handles events, in event mode */
} Instance;

/* Where a step leads: the states and inputs at its end, in the memory where it does not change them, else here. */
typedef struct {
    const State *x;
    const State *coming;
    const Input *u;
    double to_tick;
    State states[2];
    Input inputs;
} Next;

/* What is in the way of a step. */
typedef struct {
    const char *state;    /* the name of one that changes fast; NULL: nothing */
    int shorter_steps_do; /* it can be followed, but it takes too long */
} Obstacle;

/* What a directional derivative is asked of, and along which change. */
typedef struct {
    const Reference *unknown;
    size_t unknowns;
    const Reference *known;
    size_t knowns;
    const double *change; /* of each known */
} Direction;

#if defined __GNUC__
#define LIKE_PRINTF __attribute__((format(printf, 2, 3)))
#define RARE __attribute__((cold, noinline)) /* a function that steps do not call is kept out of those that they do */
#else
#define LIKE_PRINTF
#define RARE
#endif

/* the adapter */
static const char *const type_names[ENUMERATION + 1]; /* what its standard calls them */

/* calls.c */
enum {
    RUNNING = STEPPING | EVENT | CONTINUOUS_TIME,
    ANY_MODE = INSTANTIATED | INITIALIZATION | RUNNING | TERMINATED
};
static Instance *ready(void *component, unsigned modes, int complete, const char *function); /* NULL if refused */
static Instance *ready_for(Kind kind, void *component, unsigned modes, int complete, const char *function);
static const char *category_of(Status status); /* of messages */
static int orders_are_one(const Instance *instance, const int orders[], size_t count); /* of derivatives; else refused */
static Status set_logging(Instance *instance, int on, size_t count, const char *const categories[]);

/* messages.c */
enum { NUMBER_LENGTH = 40, MESSAGE_LENGTH = 1000 };
static char *write_number(char text[NUMBER_LENGTH], double value); /* as Python's repr */
LIKE_PRINTF RARE static Status refuse(const Instance *instance, const char *format, ...);  /* tells the host; ERROR */
LIKE_PRINTF RARE static Status discard(const Instance *instance, const char *format, ...); /* tells the host; DISCARD */

/* run.c */
static void renew(Instance *instance); /* as new, with the same host */
static int in_mode(const Instance *instance, unsigned modes, const char *function); /* else the function is refused */
static Status set_experiment(Instance *instance, double start_time, double stop_time);
static void leave_initialization(Instance *instance);
static Status make_step(Instance *instance, double time, double step_size);

/* values.c; the values are double for REAL, else int */
static void set_start_values(Memory *memory);
static State present_state(const Memory *memory);
#if INDICATORS
static void present_indicators(const Memory *memory, real z[INDICATORS]); /* with their hysteresis */
#endif
static Status compute_next_outputs(Instance *instance, const Next *next, double step_size); /* refused if not finite */
static Status get_values(Instance *instance, Type type, const Reference references[], size_t count, void *values);
static Status set_values(Instance *instance, Type type, const Reference references[], size_t count, const void *values);
static void take_over_written(Instance *instance); /* parameters that a tool wrote; those that cannot be go back */
static Status refuse_reference(const Instance *instance, Reference reference, const char *asked); /* ERROR */
static const Variable *variable_of(const Instance *instance, Reference reference, Type type); /* NULL if refused */
static const char *write_value(char text[NUMBER_LENGTH], Type type, double value);
static double *place_of(Values *values, const Variable *variable);
static double *rate_of(Input *du, const Variable *input);

#ifdef TERMINAL
/* terminal.c */
static void open_terminal(Memory *memory);
static int send_frame(Memory *memory); /* if its counter has gone on; 0 if there is no room for it */
static void update_terminal(Terminal *terminal); /* what was to be sent has been; what has come in is answered */
static Status check_terminal(const Instance *instance, const Terminal *terminal); /* of a saved state */

/* frames.c */
static Status step_and_send(Instance *instance, double time, double step_size); /* make_step, and its frames sent */
#endif

/* first_instance.c */
static void *first_place(size_t size);                  /* zeros for an adapter; NULL if it is taken, or too small */
static int left_first_place(const void *component);     /* whether it was there; then the place is free */
static void know_parameters(const Instance *instance);  /* after they were set by a call */
static int has_written(const Instance *instance);       /* whether a tool wrote parameters since */
static void take_back(Instance *instance);              /* what it wrote */

/* state.c */
static Status get_state(Instance *instance, void **state); /* into a new one, if it is NULL */
static Status set_state(Instance *instance, const void *state); /* refused if it is of the other kind */
static size_t serialized_size(void);
static Status serialize_state(const Instance *instance, const void *state, void *bytes, size_t size);
static Status deserialize_state(const Instance *instance, const void *bytes, size_t size, void **state);

/* content.c */
static const char *kind_name(Kind kind);
static Status check_kind(const Instance *instance, const Memory *memory); /* whose instance does the same */
static Status check_content(const Instance *instance, Memory *memory); /* of a saved state */

/* continuous.c or sampled.c */
static Status check_to_tick(const Instance *instance, const Memory *memory); /* of a saved state */
static Obstacle advance(const Memory *memory, double duration, Next *next);
static const Input *moving(const Memory *memory); /* the rates of change of the inputs; NULL if they are held */
static Status check_moving_inputs(Instance *instance, double duration); /* refused if one leaves its range */
static Status set_input_rates(Instance *instance, const Reference references[], size_t count, const double rates[]);
static Status get_output_rates(const Instance *instance, const Reference references[], size_t count, double rates[]);
static Status get_directional_derivative(const Instance *instance, const Direction *direction, double result[]);

#endif

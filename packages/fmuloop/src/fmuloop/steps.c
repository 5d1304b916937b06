/* The steps of the master: the same calls in the same order as in steps.py. The library is loaded
 * and given the addresses of the FMI functions and of their arguments by compiled_steps.py. */

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

enum { OK, WARNING, DISCARD }; /* the same in FMI 2.0 and 3.0 */

/* The status, which no FMU returns, of a call that put out NaN or infinity: NOT_FINITE in steps.py */
enum { NOT_FINITE = INT32_MIN };

/* CallRecord in call_trace.py: the call that was begun last, where another process may look at it. */
struct call_record {
    int32_t instance;
    int32_t function;
    double time;
    int64_t calls;
};

EXPORT struct call_record *call_record;

#ifdef DIGEST /* of this file, by setup.py: compiled_steps.py takes no library that was made of another */
EXPORT const char digest[] = DIGEST;
#endif

/* CompiledLine in compiled_steps.py: Line in input_lines.py */
typedef struct {
    double *sent;
    double factor;
    const double *end;
    const double *before;
    const double *after;
} Line;

/* TYPES in compiled_steps.py */
enum { REAL, WHOLE, LONG, TRUTH };

/* CompiledCall in compiled_steps.py */
typedef struct {
    int32_t fmi;              /* 2 or 3 */
    void (*access)(void);     /* sets or gets values */
    void (*do_step)(void);
    void *component;
    const uint32_t *references;
    size_t count;
    void *values;             /* that are set or got */
    const uint32_t *sources;  /* of what is set: bytes from the beginning of the row; null: nothing is set */
    const double *factors;    /* the FMU's values times these are those of the row; null: they are the same */
    int32_t type;             /* of the values */
    int32_t is_number;        /* what is got must be finite */
    int32_t *place;           /* in the row, to which whole numbers are brought; null: the values are there */
    const double *step_size;  /* in s, of calls that depend on it */
    int32_t instance;         /* numbers for call_record */
    int32_t function;
    void (*rates)(void);      /* sets or gets derivatives */
    const int32_t *orders;
    const Line *lines;        /* along which inputs are set to move; null: none */
    int32_t slopes;           /* of these the slopes are set, not the starts */
    int32_t every;            /* it is made every so many steps */
    int32_t lead;             /* whether these are counted by the end of the step */
} Call;

typedef int32_t Access2(void *component, const uint32_t *references, size_t count, void *values);
typedef int32_t Access3(void *component, const uint32_t *references, size_t count, void *values, size_t number);
typedef int32_t Rates2(void *component, const uint32_t *references, size_t count, const int32_t *orders, void *values);
typedef int32_t Rates3(
    void *component, const uint32_t *references, size_t count, const int32_t *orders, void *values, size_t number);
typedef int32_t DoStep2(void *component, double time, double step_size, int32_t no_set_before);
typedef int32_t DoStep3(
    void *component, double time, double step_size, bool no_set_before, bool *event, bool *ended, bool *early,
    double *reached);

/* Sets or gets values or derivatives. */
static int32_t exchange(const Call *call)
{
    if (call->rates && call->fmi == 3) {
        return ((Rates3 *)call->rates)(
            call->component, call->references, call->count, call->orders, call->values, call->count);
    }
    if (call->rates) {
        return ((Rates2 *)call->rates)(call->component, call->references, call->count, call->orders, call->values);
    }
    if (call->fmi == 3) {
        return ((Access3 *)call->access)(call->component, call->references, call->count, call->values, call->count);
    }
    return ((Access2 *)call->access)(call->component, call->references, call->count, call->values);
}

/* Makes the step that ends with the step k; an FMU that then asks for the end of the simulation has discarded it. */
static int32_t step(const Call *call, double time, size_t k)
{
    double size = *call->step_size;
    if (call->every > 1) {
        time = ((double)k + 1.0 - call->every) * size;
        size *= call->every;
    }
    bool event = false, ended = false, early = false;
    double reached = time;
    if (call->fmi == 2) {
        return ((DoStep2 *)call->do_step)(call->component, time, size, 1);
    }
    const int32_t status = ((DoStep3 *)call->do_step)(
        call->component, time, size, true, &event, &ended, &early, &reached);
    return ended && (status == OK || status == WARNING) ? DISCARD : status;
}

/* Whole numbers as calls have them. */
static int64_t whole(const Call *call, size_t i)
{
    switch (call->type) {
    case LONG:
        return ((const int64_t *)call->values)[i];
    case TRUTH:
        return ((const bool *)call->values)[i];
    default:
        return ((const int32_t *)call->values)[i];
    }
}

static void set_whole(const Call *call, size_t i, int32_t value)
{
    switch (call->type) {
    case LONG:
        ((int64_t *)call->values)[i] = value;
        break;
    case TRUTH:
        ((bool *)call->values)[i] = value != 0;
        break;
    default:
        ((int32_t *)call->values)[i] = value;
    }
}

/* Whether the values of the row that feed the inputs have changed; then they are taken over. */
static int changed(const Call *call, const unsigned char *row)
{
    int different = 0;
    for (size_t i = 0; i < call->count; i++) {
        const unsigned char *source = row + call->sources[i];
        if (call->type == REAL) {
            double value;
            memcpy(&value, source, sizeof value);
            if (call->factors) {
                value /= call->factors[i];
            }
            double *sent = (double *)call->values + i;
            different |= !(value == *sent);
            *sent = value;
        } else {
            int32_t value;
            memcpy(&value, source, sizeof value);
            different |= value != whole(call, i);
            set_whole(call, i, value);
        }
    }
    return different;
}

/* The values that were got, in the units of the loop. */
static void convert(const Call *call)
{
    double *values = call->values;
    for (size_t i = 0; i < call->count; i++) {
        values[i] *= call->factors[i];
    }
}

/* The slope and the start of a line for a step of h s, as in input_lines.py. */
static double slope(const Line *line, double h)
{
    if (!line->end) {
        return *line->before / line->factor;
    }
    const double way = *line->end / line->factor - *line->sent;
    if (!line->after) {
        return way / h;
    }
    return (1.2 * way - 0.1 * h * ((*line->before + *line->after) / line->factor)) / h;
}

static double start(const Line *line, double h)
{
    if (!line->after) {
        return *line->sent;
    }
    const double way = *line->end / line->factor - *line->sent;
    const double mean = *line->sent + 0.5 * way + h * ((*line->before - *line->after) / line->factor) / 12.0;
    return mean - 0.5 * h * slope(line, h);
}

/* What is set so that inputs move along lines; once they do, what was sent before is forgotten. */
static void aim(const Call *call)
{
    double *values = call->values;
    for (size_t i = 0; i < call->count; i++) {
        const Line *line = &call->lines[i];
        values[i] = call->slopes ? slope(line, *call->step_size) : start(line, *call->step_size);
        if (call->slopes) {
            *line->sent = NAN;
        }
    }
}

/* Whether all values that were got are numbers. */
static int all_finite(const Call *call)
{
    const double *values = call->values;
    for (size_t i = 0; i < call->count; i++) {
        if (!isfinite(values[i])) {
            return 0;
        }
    }
    return 1;
}

/* Makes the call of the step k, unless it is not due; what it puts out is looked at. */
static int32_t made(const Call *call, const unsigned char *row, size_t k)
{
    if (call->every > 1 && (k + (size_t)call->lead) % (size_t)call->every) {
        return OK;
    }
    if (call->lines) {
        aim(call);
    } else if (call->sources && !changed(call, row)) {
        return OK;
    }
    call_record->instance = call->instance;
    call_record->function = call->function;
    memcpy(&call_record->time, row, sizeof call_record->time);
    call_record->calls++;
    if (call->do_step) {
        double time;
        memcpy(&time, row, sizeof time);
        return step(call, time, k);
    }
    const int32_t status = exchange(call);
    if (call->factors && !call->sources) {
        convert(call);
    }
    for (size_t i = 0; call->place && i < call->count; i++) {
        call->place[i] = (int32_t)whole(call, i);
    }
    if (call->is_number && (status == OK || status == WARNING) && !all_finite(call)) {
        return NOT_FINITE;
    }
    return status;
}

/* Makes the calls first ... last - 1 of the step k up to one that is refused; returns its number, or last. */
static size_t make(
    const Call *calls, size_t first, size_t last, const unsigned char *row, size_t k, int32_t *status)
{
    for (size_t i = first; i < last; i++) {
        *status = made(&calls[i], row, k);
        if (*status != OK && *status != WARNING) {
            return i;
        }
    }
    return last;
}

/* Makes the steps that begin with the rows first ... last - 1 of the table, and fills the rows after them. Time goes
 * on to the next instant before call number `turn`. Returns the number of the step that was not finished, or last; then
 * refused and status tell the call. */
EXPORT size_t make_steps(const Call *calls, size_t turn, size_t number, unsigned char *row, size_t known,
                         unsigned char *table, size_t size, size_t first, size_t last, size_t *refused,
                         int32_t *status)
{
    for (size_t k = first; k < last; k++) {
        unsigned char *next = table + (k + 1) * size;
        *refused = make(calls, 0, turn, row, k, status);
        if (*refused == turn) {
            memcpy(row, next, known);
            *refused = make(calls, turn, number, row, k, status);
        }
        if (*refused < number) {
            return k;
        }
        memcpy(next + known, row + known, size - known);
    }
    return last;
}

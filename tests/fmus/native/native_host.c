/* A host that calls the functions of one FMU in random order, with arguments that make sense and with others.

It is compiled together with the sources of the FMU under the address and undefined-behaviour sanitizers: what
goes wrong ends the program. With NUMBER_OF_STATES and NUMBER_OF_INDICATORS defined half of the instances are for model exchange. Usage:
native_host GUID SEED CALLS */
#include "fmi2Functions.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 8, INSTANCES = 3, STATES = 4, WIDEST = 30 };

#define CASE(number, call) \
    case number:           \
        call;              \
        break;

static unsigned long long random_state;
static size_t allocations;

static unsigned draw(unsigned below)
{
    random_state = random_state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (unsigned)(random_state >> 33) % below;
}

static void *allocate(size_t count, size_t size)
{
    if (draw(20) == 0)
        return NULL;
    allocations++;
    return calloc(count, size);
}

static void give_back(void *memory)
{
    allocations -= memory != NULL;
    free(memory);
}

static void write_message(
    fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category, fmi2String message, ...)
{
    size_t *longest = environment;
    const size_t length = strlen(message) + strlen(name) + strlen(category) + (size_t)status;
    *longest = length > *longest ? length : *longest;
}

static double number(void)
{
    static const double odd[] = {0.0, -0.0, 1.0, -1.0, 1e-3, 1e300, DBL_MAX, 5e-324, 2001.0};
    switch (draw(6)) {
    case 0:
        return (double)NAN;
    case 1:
        return (double)INFINITY * (draw(2) ? 1.0 : -1.0);
    case 2:
        return odd[draw(sizeof odd / sizeof *odd)];
    default:
        return (draw(2001) - 1000.0) / 10.0;
    }
}

typedef struct {
    fmi2Component instance;
    fmi2FMUstate states[STATES];
    double time;
} Slot;

static void set_or_get(Slot *slot)
{
    fmi2ValueReference references[MOST];
    double reals[MOST];
    int integers[MOST], orders[MOST];
    fmi2String strings[MOST];
    const size_t count = draw(MOST);
    for (size_t k = 0; k < MOST; k++) {
        references[k] = draw(20) ? draw(12) : draw(2) ? draw(100) : 4294967295U;
        reals[k] = number();
        integers[k] = (int)draw(3);
        orders[k] = 1 + (draw(5) == 0);
        strings[k] = "text";
    }
    const fmi2ValueReference *from = draw(30) ? references : NULL;
    double *real = draw(30) ? reals : NULL;
    int *whole = draw(30) ? integers : NULL;
    switch (draw(11)) {
    CASE(0, fmi2SetReal(slot->instance, from, count, real))
    CASE(1, fmi2SetInteger(slot->instance, from, count, whole))
    CASE(2, fmi2SetBoolean(slot->instance, from, count, whole))
    CASE(3, fmi2SetString(slot->instance, from, count, strings))
    CASE(4, fmi2GetReal(slot->instance, from, count, real))
    CASE(5, fmi2GetInteger(slot->instance, from, count, whole))
    CASE(6, fmi2GetBoolean(slot->instance, from, count, whole))
    CASE(7, fmi2GetString(slot->instance, from, count, strings))
    CASE(8, fmi2SetRealInputDerivatives(slot->instance, from, count, orders, real))
    CASE(9, fmi2GetRealOutputDerivatives(slot->instance, from, count, orders, real))
    default: {
        double changes[MOST] = {1.0};
        fmi2GetDirectionalDerivative(slot->instance, from, count, references, draw(MOST), changes, real);
    }
    }
}

/* Gives the bytes of a state the CRC-32 that makes them whole. */
static void make_whole(fmi2Byte *bytes, size_t size)
{
    unsigned sum = 0xFFFFFFFFU;
    for (size_t k = sizeof sum; k < size; k++) {
        sum ^= (unsigned char)bytes[k];
        for (int bit = 0; bit < 8; bit++)
            sum = (sum >> 1) ^ (0xEDB88320U & (0U - (sum & 1U)));
    }
    sum = ~sum;
    memcpy(bytes, &sum, sizeof sum);
}

/* A bit or a number of a state that no longer is what was saved. */
static void damage(fmi2Byte *bytes, size_t size)
{
    const double wrong = draw(2) ? number() : draw(2) ? -1e18 : 0.5;
    if (draw(2))
        bytes[draw((unsigned)size)] ^= (fmi2Byte)(1 << draw(7));
    else
        memcpy(bytes + 8 * draw((unsigned)size / 8), &wrong, sizeof wrong);
    if (draw(4))
        make_whole(bytes, size);
}

static void save_or_restore(Slot *slot)
{
    fmi2Byte bytes[8192];
    size_t size = 0;
    fmi2FMUstate *state = &slot->states[draw(STATES)];
    switch (draw(6)) {
    CASE(0, fmi2GetFMUstate(slot->instance, draw(20) ? state : NULL))
    CASE(1, fmi2SetFMUstate(slot->instance, *state))
    CASE(2, fmi2FreeFMUstate(slot->instance, draw(20) ? state : NULL))
    CASE(3, fmi2SerializedFMUstateSize(slot->instance, *state, draw(20) ? &size : NULL))
    default:
        if (fmi2SerializedFMUstateSize(slot->instance, *state, &size) != fmi2OK || size > sizeof bytes)
            break;
        fmi2SerializeFMUstate(slot->instance, *state, bytes, size - draw(2));
        if (draw(3) == 0)
            damage(bytes, size);
        fmi2DeSerializeFMUstate(slot->instance, bytes, size - (draw(10) == 0), state);
    }
}

static void ask_status(Slot *slot)
{
    const fmi2StatusKind kind = (fmi2StatusKind)draw(4);
    fmi2Status status;
    fmi2Real real;
    fmi2Integer whole;
    fmi2String text;
    fmi2GetStatus(slot->instance, kind, draw(20) ? &status : NULL);
    fmi2GetRealStatus(slot->instance, kind, draw(20) ? &real : NULL);
    fmi2GetIntegerStatus(slot->instance, kind, draw(20) ? &whole : NULL);
    fmi2GetBooleanStatus(slot->instance, kind, draw(20) ? &whole : NULL);
    fmi2GetStringStatus(slot->instance, kind, draw(20) ? &text : NULL);
}

static void change_mode(Slot *slot)
{
    const fmi2String categories[] = {"logStatusError", "logStatusDiscard", "%s%n", NULL};
    switch (draw(12)) {
    CASE(0, fmi2SetupExperiment(slot->instance, 0, 0.0, draw(3) ? 0.0 : number(), draw(3) == 0, draw(3) ? 9.0 : number()))
    case 1:
    case 2:
    CASE(3, fmi2EnterInitializationMode(slot->instance))
    case 4:
    case 5:
    case 6:
    CASE(7, fmi2ExitInitializationMode(slot->instance))
    case 8:
        if (draw(10) == 0)
            fmi2Terminate(slot->instance);
        break;
    case 9:
        if (draw(10) == 0)
            fmi2Reset(slot->instance);
        break;
    CASE(10, fmi2CancelStep(slot->instance))
    default:
        fmi2SetDebugLogging(slot->instance, draw(4) > 0, draw(5), draw(20) ? categories : NULL);
    }
}

static void step(Slot *slot)
{
    double time = 0.0;
    if (draw(10) && fmi2GetRealStatus(slot->instance, fmi2LastSuccessfulTime, &time) != fmi2OK)
        time = 0.0;
    const double size = draw(5) ? draw(50) * 1e-4 : number();
    fmi2DoStep(slot->instance, time, size > 1.0 && size <= DBL_MAX ? 1.0 : size, 0);
}

#ifdef NUMBER_OF_STATES
static void integrate(Slot *slot)
{
    double values[WIDEST];
    fmi2Boolean enter, end;
    fmi2EventInfo info;
    const size_t count = draw(10) ? NUMBER_OF_STATES : draw(WIDEST);
    const size_t indicators = draw(10) ? NUMBER_OF_INDICATORS : draw(WIDEST);
    for (size_t k = 0; k < WIDEST; k++)
        values[k] = draw(30) ? draw(100) * 1e-2 : number();
    switch (draw(12)) {
    CASE(0, fmi2EnterEventMode(slot->instance))
    CASE(1, fmi2NewDiscreteStates(slot->instance, draw(20) ? &info : NULL))
    case 2:
    CASE(3, fmi2EnterContinuousTimeMode(slot->instance))
    CASE(4, fmi2CompletedIntegratorStep(slot->instance, 0, draw(20) ? &enter : NULL, draw(20) ? &end : NULL))
    CASE(5, fmi2SetTime(slot->instance, number()))
    CASE(6, fmi2GetDerivatives(slot->instance, draw(20) ? values : NULL, count))
    CASE(7, fmi2GetEventIndicators(slot->instance, draw(20) ? values : NULL, indicators))
    CASE(8, fmi2GetNominalsOfContinuousStates(slot->instance, draw(20) ? values : NULL, count))
    CASE(9, fmi2GetContinuousStates(slot->instance, draw(20) ? values : NULL, count))
    default:
        fmi2SetContinuousStates(slot->instance, draw(20) ? values : NULL, count);
    }
}

static fmi2Type any_type(void)
{
    return draw(2) ? fmi2ModelExchange : fmi2CoSimulation;
}
#else
static void integrate(Slot *slot)
{
    (void)slot;
}

static fmi2Type any_type(void)
{
    return draw(20) ? fmi2CoSimulation : fmi2ModelExchange;
}
#endif

static void free_slot(Slot *slot)
{
    for (int k = 0; k < STATES; k++)
        fmi2FreeFMUstate(slot->instance, &slot->states[k]);
    fmi2FreeInstance(slot->instance);
    slot->instance = NULL;
}

int main(int count, char *arguments[])
{
    size_t longest = 0;
    const fmi2CallbackFunctions callbacks = {write_message, allocate, give_back, NULL, &longest};
    const fmi2CallbackFunctions no_logger = {NULL, allocate, give_back, NULL, NULL};
    const fmi2CallbackFunctions no_memory = {write_message, NULL, NULL, NULL, &longest};
    const fmi2CallbackFunctions *choice[] = {&callbacks, &callbacks, &callbacks, &no_logger, &no_memory, NULL};
    Slot slots[INSTANCES] = {{NULL, {NULL}, 0.0}};
    if (count != 4)
        return 2;
    random_state = (unsigned long long)atoll(arguments[2]);
    for (long calls = atol(arguments[3]); calls > 0; calls--) {
        Slot *slot = &slots[draw(INSTANCES)];
        if (!slot->instance)
            slot->instance = fmi2Instantiate(
                "100 %s", any_type(), draw(10) ? arguments[1] : "{%d}", NULL, choice[draw(6)], 0, draw(5) > 0);
        switch (draw(10)) {
        case 0:
            CASE(1, set_or_get(slot))
            CASE(2, save_or_restore(slot))
            CASE(3, ask_status(slot))
            CASE(4, change_mode(slot))
        case 5:
            if (draw(100) == 0 && slot->instance)
                free_slot(slot);
            break;
        case 6:
            CASE(7, integrate(slot))
        default:
            step(slot);
        }
    }
    for (int k = 0; k < INSTANCES; k++)
        if (slots[k].instance)
            free_slot(&slots[k]);
    printf("longest message %lu, not freed %lu\n", (unsigned long)longest, (unsigned long)allocations);
    return allocations != 0;
}

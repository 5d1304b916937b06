/* Saved states that no instance wrote: the bytes of a sound one with some numbers changed and the checksum made anew, from
before, in and after initialization mode. One that is taken must be followed to numbers without hanging. It is compiled
together with the sources of an FMU. Usage: forged_states GUID SEED STATES; it prints how many were taken. */
#include "fmi2Functions.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { HEAD = 48, CHANGES = 3, STEPS = 5, PATIENCE = 20 };

static uint64_t random_state;

static unsigned draw(unsigned below)
{
    random_state = random_state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (unsigned)(random_state >> 33) % below;
}

static void ignore(
    fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category, fmi2String text, ...)
{
    (void)environment, (void)name, (void)status, (void)category, (void)text;
}

static const fmi2CallbackFunctions callbacks = {ignore, calloc, free, NULL, NULL};

static uint32_t checksum(const unsigned char *bytes, size_t size)
{
    uint32_t sum = ~0U;
    for (size_t k = sizeof sum; k < size; k++) {
        sum ^= bytes[k];
        for (int bit = 0; bit < 8; bit++)
            sum = (sum >> 1) ^ (0xEDB88320U & (0U - (sum & 1U)));
    }
    return ~sum;
}

static double odd(void)
{
    static const double numbers[] = {0.0, -0.0, 1.0,   -1.0, 1e15,         -1e15,         1e300, -1e300, 1e9,
                                     -1e9, 0.5, 1e6, -1e17, 2147483647.0, -2147483648.0, 5e-324};
    switch (draw(8)) {
    case 0:
        return (double)NAN;
    case 1:
        return draw(2) ? (double)INFINITY : -(double)INFINITY;
    case 2:
    case 3:
        return (draw(2001) - 1000.0) / 10.0;
    default:
        return numbers[draw(sizeof numbers / sizeof *numbers)];
    }
}

static void forge(unsigned char *bytes, size_t size)
{
    for (unsigned k = 1 + draw(CHANGES); k > 0; k--) {
        const size_t place = HEAD + 8 * (size_t)draw((unsigned)(size - HEAD) / 8);
        const int64_t whole = (int64_t)draw(70) - 3;
        const double number = odd();
        memcpy(bytes + place, draw(4) ? (const void *)&number : (const void *)&whole, 8);
    }
    const uint32_t sum = checksum(bytes, size);
    memcpy(bytes, &sum, sizeof sum);
}

/* The instance goes on as far as it can. */
static void follow(fmi2Component one)
{
    fmi2EnterInitializationMode(one);
    fmi2ExitInitializationMode(one);
    for (int k = 0; k < STEPS; k++) {
        double time;
        if (fmi2GetRealStatus(one, fmi2LastSuccessfulTime, &time) != fmi2OK || fmi2DoStep(one, time, 1e-3, 1) != fmi2OK)
            return;
    }
}

static int tried(const char *guid)
{
    fmi2Component one = fmi2Instantiate("one", fmi2CoSimulation, guid, NULL, &callbacks, 0, 0);
    const unsigned stage = draw(3);
    fmi2SetupExperiment(one, 0, 0, 0, 0, 0);
    if (stage > 0)
        fmi2EnterInitializationMode(one);
    if (stage > 1) {
        fmi2ExitInitializationMode(one);
        for (unsigned k = 0, steps = draw(20); k < steps; k++)
            fmi2DoStep(one, k * 1e-3, 1e-3, 1);
    }
    fmi2FMUstate state = NULL, forged = NULL;
    size_t size = 0;
    fmi2GetFMUstate(one, &state);
    fmi2SerializedFMUstateSize(one, state, &size);
    fmi2Byte *bytes = malloc(size);
    fmi2SerializeFMUstate(one, state, bytes, size);
    forge((unsigned char *)bytes, size);
    const int taken = fmi2DeSerializeFMUstate(one, bytes, size, &forged) == fmi2OK && fmi2SetFMUstate(one, forged) == fmi2OK;
    if (taken)
        follow(one);
    fmi2FreeFMUstate(one, &forged);
    fmi2FreeFMUstate(one, &state);
    fmi2FreeInstance(one);
    free(bytes);
    return taken;
}

int main(int count, char **arguments)
{
    long taken = 0;
    if (count != 4)
        return 2;
    random_state = strtoull(arguments[2], NULL, 10);
    for (long k = strtol(arguments[3], NULL, 10); k > 0; k--) {
        alarm(PATIENCE); /* a step without end ends the program */
        taken += tried(arguments[1]);
    }
    printf("%ld\n", taken);
    return 0;
}

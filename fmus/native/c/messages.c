/* What the FMU tells its host, through the logger of the host alone. */
#include "instance.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MESSAGE_LENGTH = 1000, DIGITS = 17 };

static const char *const category_names[LOG_CATEGORIES] = {"logStatusError", "logStatusDiscard"};

int category_of(const char *name)
{
    for (int k = 0; name && k < LOG_CATEGORIES; k++)
        if (strcmp(name, category_names[k]) == 0)
            return k;
    return -1;
}

/* The logger takes the message for a format. */
static void write_percent_signs_twice(char escaped[2 * MESSAGE_LENGTH], const char *message)
{
    while (*message) {
        if (*message == '%')
            *escaped++ = '%';
        *escaped++ = *message++;
    }
    *escaped = '\0';
}

static void log_message(
    const fmi2CallbackFunctions *callbacks, fmi2String name, fmi2Status status, int category, const char *message)
{
    char escaped[2 * MESSAGE_LENGTH];
    write_percent_signs_twice(escaped, message);
    callbacks->logger(callbacks->componentEnvironment, name, status, category_names[category], escaped);
}

void log_without_instance(const fmi2CallbackFunctions *callbacks, fmi2String name, const char *message)
{
    if (callbacks->logger)
        log_message(callbacks, name ? name : "", fmi2Error, LOG_ERROR, message);
}

static void log_format(const Instance *instance, fmi2Status status, int category, const char *format, va_list arguments)
{
    char message[MESSAGE_LENGTH];
    if (!instance->callbacks.logger || !instance->logged[category])
        return;
    vsnprintf(message, sizeof message, format, arguments);
    log_message(&instance->callbacks, instance->name, status, category, message);
}

fmi2Status refuse(const Instance *instance, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    log_format(instance, fmi2Error, LOG_ERROR, format, arguments);
    va_end(arguments);
    return fmi2Error;
}

fmi2Status discard(const Instance *instance, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    log_format(instance, fmi2Discard, LOG_DISCARD, format, arguments);
    va_end(arguments);
    return fmi2Discard;
}

static const char *mode_name(unsigned mode)
{
    switch (mode) {
    case INSTANTIATED:
        return "before initialization mode";
    case INITIALIZATION:
        return "in initialization mode";
    case STEPPING:
        return "after initialization";
    default:
        return "after fmi2Terminate";
    }
}

int in_mode(const Instance *instance, unsigned modes, const char *function)
{
    const unsigned mode = (unsigned)instance->memory.mode;
    if (mode & modes)
        return 1;
    const unsigned first = modes & (~modes + 1U);
    refuse(instance, "%s is refused %s; its place is %s", function, mode_name(mode), mode_name(first));
    return 0;
}

/* Shortest digits that read back as the same number; returns the power of ten of the first digit. */
static int shortest_digits(char digits[DIGITS + 1], double value)
{
    char text[NUMBER_LENGTH];
    for (int precision = 0; precision < DIGITS; precision++) {
        snprintf(text, sizeof text, "%.*e", precision, value);
        if (strtod(text, NULL) == value)
            break;
    }
    size_t count = 0;
    const char *at = text;
    for (; *at != 'e'; at++)
        if (*at >= '0' && *at <= '9') /* the decimal sign depends on the locale of the host */
            digits[count++] = *at;
    digits[count] = '\0';
    return atoi(at + 1);
}

char *write_number(char text[NUMBER_LENGTH], double value)
{
    char digits[DIGITS + 1], *at = text;
    if (value != value)
        return strcpy(text, "nan");
    if (copysign(1.0, value) < 0.0)
        *at++ = '-';
    if (fabs(value) > DBL_MAX) {
        strcpy(at, "inf");
        return text;
    }
    const int power = shortest_digits(digits, fabs(value)), count = (int)strlen(digits);
    const size_t room = NUMBER_LENGTH - 1;
    if (power < -4 || power >= 16)
        snprintf(at, room, "%c%s%se%+03d", digits[0], count > 1 ? "." : "", digits + 1, power);
    else if (power < 0)
        snprintf(at, room, "0.%.*s%s", -power - 1, "000", digits);
    else if (count <= power + 1)
        snprintf(at, room, "%s%.*s.0", digits, power + 1 - count, "0000000000000000");
    else
        snprintf(at, room, "%.*s.%s", power + 1, digits, digits + power + 1);
    return text;
}

/* What an instance tells its host. */
#include "instance.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DIGITS = 17 };

static void tell(const Instance *instance, Status status, const char *format, va_list arguments)
{
    char message[MESSAGE_LENGTH];
    if (!instance->host.logged[status])
        return;
    vsnprintf(message, sizeof message, format, arguments);
    instance->host.log(instance->host.listener, status, message);
}

Status refuse(const Instance *instance, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tell(instance, ERROR, format, arguments);
    va_end(arguments);
    return ERROR;
}

Status discard(const Instance *instance, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tell(instance, DISCARD, format, arguments);
    va_end(arguments);
    return DISCARD;
}

/* The fewest digits that read back as the same number; returns the power of ten of the first digit. */
static int shortest_digits(char *digits, double value)
{
    char text[NUMBER_LENGTH];
    for (int precision = 0; precision < DIGITS; precision++) {
        snprintf(text, sizeof text, "%.*e", precision, value);
        if (strtod(text, NULL) == value)
            break;
        char *last = strchr(text, 'e') - 1; /* a power of two has more room above, so that one more may do */
        *last = (char)(*last + (*last < '9'));
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
    char digits[DIGITS + 1];
    const char *sign = copysign(1.0, value) < 0.0 ? "-" : "";
    if (value != value)
        return strcpy(text, "nan");
    if (fabs(value) > DBL_MAX) {
        snprintf(text, NUMBER_LENGTH, "%sinf", sign);
        return text;
    }
    const int power = shortest_digits(digits, fabs(value)), count = (int)strlen(digits);
    if (power < -4 || power >= 16)
        snprintf(text, NUMBER_LENGTH, "%s%c%s%se%+03d", sign, digits[0], count > 1 ? "." : "", digits + 1, power);
    else if (power < 0)
        snprintf(text, NUMBER_LENGTH, "%s0.%.*s%s", sign, -power - 1, "000", digits);
    else if (count <= power + 1)
        snprintf(text, NUMBER_LENGTH, "%s%s%.*s.0", sign, digits, power + 1 - count, "0000000000000000");
    else
        snprintf(text, NUMBER_LENGTH, "%s%.*s.%s", sign, power + 1, digits, digits + power + 1);
    return text;
}

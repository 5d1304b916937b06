/* What an FMU in a module calls: memory, and what it says, of which the last text is kept. */
#include "fmi2FunctionTypes.h"

#include <stdlib.h>

#define KEPT __attribute__((visibility("default")))

static char message[1024];

static void log_message(
    fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category, fmi2String text, ...)
{
    (void)environment, (void)name, (void)status, (void)category;
    size_t length = 0;
    for (; *text && length + 1 < sizeof message; text++) {
        message[length++] = *text;
        text += text[0] == '%' && text[1] == '%'; /* it is a format */
    }
    message[length] = '\0';
}

static const fmi2CallbackFunctions callbacks = {log_message, calloc, free, NULL, NULL};

/* What the last refusal says. */
KEPT const char *last_message(void);

const char *last_message(void)
{
    return message;
}

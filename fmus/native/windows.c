/* What Zig's runtime for Windows would bring, and much more with it: the entry of the library, which has nothing to
do, and printing into a buffer, which Windows has under another name. */
#include <stdarg.h>
#include <stddef.h>

enum { STANDARD_SNPRINTF = 2 }; /* returns the length that the text would have */

__declspec(dllimport) int __stdio_common_vsprintf(
    unsigned long long options, char *text, size_t size, const char *format, void *locale, va_list arguments);

int DllMainCRTStartup(void *library, unsigned reason, void *reserved);
int vsnprintf(char *text, size_t size, const char *format, va_list arguments);
int snprintf(char *text, size_t size, const char *format, ...);

int DllMainCRTStartup(void *library, unsigned reason, void *reserved)
{
    (void)library;
    (void)reason;
    (void)reserved;
    return 1;
}

int vsnprintf(char *text, size_t size, const char *format, va_list arguments)
{
    return __stdio_common_vsprintf(STANDARD_SNPRINTF, text, size, format, NULL, arguments);
}

int snprintf(char *text, size_t size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, size, format, arguments);
    va_end(arguments);
    return length;
}

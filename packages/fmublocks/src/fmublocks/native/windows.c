/* What Zig's runtime for Windows would bring, and much more with it: the entry of the library, which has nothing to
do, printing into a buffer, which Windows has under another name, and touching the pages of a large stack frame. */
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

/* Called before a frame of rax bytes, more than a page, is taken: Windows gives out a stack page by page, from above.
It leaves all registers as they are. */
__asm__(".globl ___chkstk_ms\n"
        "___chkstk_ms:\n"
        "    push %rax\n"
        "    push %rcx\n"
        "    lea 24(%rsp), %rcx\n" /* the stack of the caller */
        "1:  cmp $4096, %rax\n"
        "    jb 2f\n"
        "    sub $4096, %rcx\n"
        "    orb $0, (%rcx)\n"
        "    sub $4096, %rax\n"
        "    jmp 1b\n"
        "2:  sub %rax, %rcx\n"
        "    orb $0, (%rcx)\n"
        "    pop %rcx\n"
        "    pop %rax\n"
        "    ret\n");

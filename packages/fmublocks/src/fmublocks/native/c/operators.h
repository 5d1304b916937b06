/* What the generated arithmetic calls besides math.h. */
#ifndef OPERATORS_H
#define OPERATORS_H

#include "block.h"

#include <math.h>
#include <stdbool.h>

#if defined OLD_GLIBC && defined __x86_64__ && defined __gnu_linux__
/* The first versions of these functions: the later ones, of glibc 2.29 and 2.38, differ in errno alone, and would
   keep the binary from loading with an older glibc. Only where libm is linked, which not every tool does. */
__asm__(".symver exp, exp@GLIBC_2.2.5");
__asm__(".symver log, log@GLIBC_2.2.5");
__asm__(".symver pow, pow@GLIBC_2.2.5");
__asm__(".symver fmod, fmod@GLIBC_2.2.5");
#endif

static inline int is_integer(real x)
{
    const real most = (real)4503599627370496.0; /* 2^52 */
    return x > -most && x < most && (real)(long long)x == x;
}

/* x % y as in Python: with the sign of y. The noise has positive x and whole y, of at most 2^26 as their quotient. Then
the multiple of y nearest to x is exact, and so is what x is off from it: no need of fmod, which is slow. */
static inline real modulo(real x, real y)
{
    const real most = (real)67108864.0;              /* 2^26 */
    const real rounding = (real)6755399441055744.0;  /* 1.5 2^52: a number is a whole one after it was added */
    const real quotient = x * (1 / y);
    if (x > 0 && quotient <= most && y >= 2 && y <= most && is_integer(y)) {
        const real rest = x - ((quotient + rounding) - rounding) * y;
        return rest < 0 ? rest + y : rest;
    }
    const real rest = (real)fmod(x, y);
    if (rest == 0)
        return (real)copysign(0, y);
    return rest * y < 0 ? rest + y : rest;
}

static inline real square(real x)
{
    return x * x;
}

static inline real sign_of(real x)
{
    return (real)((x > 0) - (x < 0));
}

#endif

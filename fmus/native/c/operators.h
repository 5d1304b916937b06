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

/* x % y as in Python: with the sign of y. Integers, as the noise has them, do not need fmod, which is slow. */
static inline real modulo(real x, real y)
{
    const int integers = is_integer(x) && is_integer(y) && y != 0;
    const real rest = integers ? (real)((long long)x % (long long)y) : (real)fmod(x, y);
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

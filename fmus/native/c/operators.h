/* What the generated arithmetic calls besides math.h. */
#ifndef OPERATORS_H
#define OPERATORS_H

#include "block.h"

#include <math.h>

#if defined OLD_GLIBC && defined __x86_64__ && defined __gnu_linux__
/* The first versions of these functions: the later ones, of glibc 2.29 and 2.38, differ in errno alone, and would
   keep the binary from loading with an older glibc. Only where libm is linked, which not every tool does. */
__asm__(".symver exp, exp@GLIBC_2.2.5");
__asm__(".symver log, log@GLIBC_2.2.5");
__asm__(".symver pow, pow@GLIBC_2.2.5");
__asm__(".symver fmod, fmod@GLIBC_2.2.5");
#endif

/* x % y as in Python: with the sign of y. Whole numbers, as the noise has them, do not need fmod, which is slow. */
static inline real modulo(real x, real y)
{
    const real whole = (real)4503599627370496.0; /* 2^52 */
    if (x >= 0 && x < whole && y >= 1 && y < whole) {
        const long long m = (long long)x, n = (long long)y;
        if ((real)m == x && (real)n == y)
            return (real)(m % n);
    }
    const real rest = (real)fmod(x, y);
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

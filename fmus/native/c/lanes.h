/* Arithmetic on the numbers of several cars at a time, one in each lane of a vector of the processor.

WIDTH is their number. Vector extensions of GCC and Clang; sine and the like are those of libmvec of the GNU C library,
which are off by less than 4 units of the last place and keep NaN. */
#ifndef LANES_H
#define LANES_H

#include "operators.h"

#include <immintrin.h>
#include <stdint.h>

typedef double lanes __attribute__((vector_size(8 * WIDTH)));
typedef int64_t mask __attribute__((vector_size(8 * WIDTH))); /* of each lane all bits or none; also whole numbers */

#define EACH_LANE(lane) for (int lane = 0; lane < WIDTH; lane++)

#if WIDTH == 8
#define VECTOR(function) _ZGVeN8v_##function
#else
#define VECTOR(function) _ZGVdN4v_##function
#endif

lanes VECTOR(sin)(lanes x);
lanes VECTOR(cos)(lanes x);
lanes VECTOR(tan)(lanes x);
lanes VECTOR(atan)(lanes x);
lanes VECTOR(exp)(lanes x);
lanes VECTOR(log)(lanes x);

#define sin_in_lanes VECTOR(sin)
#define cos_in_lanes VECTOR(cos)
#define tan_in_lanes VECTOR(tan)
#define atan_in_lanes VECTOR(atan)
#define exp_in_lanes VECTOR(exp)
#define log_in_lanes VECTOR(log)

static inline lanes all_lanes(double value)
{
    return value - (lanes){0};
}

/* Within 2e-16; half as long as that of the library. */
static inline lanes tanh_in_lanes(lanes x)
{
    return 1.0 - 2.0 / (exp_in_lanes(2.0 * x) + 1.0);
}

static inline int is_any(mask m)
{
#if WIDTH == 8
    return _mm512_movepi64_mask((__m512i)m) != 0;
#else
    return _mm256_movemask_pd((__m256d)m) != 0;
#endif
}

static inline lanes sqrt_in_lanes(lanes x)
{
#if WIDTH == 8
    return (lanes)_mm512_sqrt_pd((__m512d)x);
#else
    return (lanes)_mm256_sqrt_pd((__m256d)x);
#endif
}

static inline lanes floor_in_lanes(lanes x)
{
#if WIDTH == 8
    return (lanes)_mm512_roundscale_pd((__m512d)x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
#else
    return (lanes)_mm256_floor_pd((__m256d)x);
#endif
}

/* `yes` where the mask is set, else `no`. */
static inline lanes chosen(mask m, lanes yes, lanes no)
{
    return (lanes)((m & (mask)yes) | (~m & (mask)no));
}

static inline lanes fabs_in_lanes(lanes x)
{
    return (lanes)((mask)x & ~(mask)all_lanes(-0.0));
}

static inline lanes square_in_lanes(lanes x)
{
    return x * x;
}

static inline lanes sign_of_in_lanes(lanes x)
{
    return chosen(x > 0.0, all_lanes(1.0), chosen(x < 0.0, all_lanes(-1.0), all_lanes(0.0)));
}

/* The same as modulo of operators.h. The quotient may be one off, as the divisor is nearly always a constant whose inverse
the compiler knows; the rest is exact: what is multiplied and subtracted is rounded once. */
static inline __attribute__((always_inline)) lanes modulo_in_lanes(lanes x, lanes y)
{
    const lanes quotient = floor_in_lanes(x * (1.0 / y)), none = {0};
    lanes rest = x - quotient * y;
    const mask positive = y > 0.0, below = (positive & (rest < 0.0)) | (~positive & (rest > 0.0));
    const mask above = (positive & (rest >= y)) | (~positive & (rest <= y));
    rest = rest + chosen(below, y, chosen(above, -y, none));
    if (__builtin_expect(is_any(~(fabs_in_lanes(quotient) < 1125899906842624.0)), 0)) /* 2^50 */
        EACH_LANE(k) rest[k] = modulo(x[k], y[k]);
    return rest;
}

/* The whole part of a position, not less than 0 and not more than that; of one that is not a number it is 0. */
static inline mask index_of(lanes position, int most)
{
    const lanes some = chosen(position >= 1.0, position, all_lanes(0.0));
    return __builtin_convertvector(chosen(some < (double)most, some, all_lanes(most)), mask);
}

static inline lanes whole(mask index)
{
    return __builtin_convertvector(index, lanes);
}

static inline lanes element(const lanes *array, mask index)
{
    lanes found;
    EACH_LANE(k) found[k] = array[index[k]][k];
    return found;
}

#endif

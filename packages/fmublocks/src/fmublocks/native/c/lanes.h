/* Arithmetic on the numbers of several cars at a time, one in each lane of a vector of the processor.

WIDTH is their number. Vector extensions of GCC and Clang. Sine and the like have the polynomials of fdlibm (Sun
Microsystems, 1993), are off by at most 4e-16 of the largest value or of their own, and keep NaN. */
#ifndef LANES_H
#define LANES_H

#include "operators.h"

#include <immintrin.h>
#include <stdint.h>

typedef double lanes __attribute__((vector_size(8 * WIDTH)));
typedef int64_t mask __attribute__((vector_size(8 * WIDTH))); /* of each lane all bits or none; also whole numbers */

#define ALWAYS inline __attribute__((always_inline))

#define EACH_LANE(lane) for (int lane = 0; lane < WIDTH; lane++)

#if WIDTH == 8
typedef __m512d packed;
#define PACKED(operation) _mm512_##operation##_pd
#else
typedef __m256d packed;
#define PACKED(operation) _mm256_##operation##_pd
#endif

static inline lanes all_lanes(double value)
{
    return value - (lanes){0};
}

/* Of each lane the sign. */
static inline int signs(mask m)
{
#if WIDTH == 8
    return _mm512_movepi64_mask((__m512i)m);
#else
    return _mm256_movemask_pd((__m256d)m);
#endif
}

static inline int is_any(mask m)
{
    return signs(m) != 0;
}

static inline int are_all(mask m)
{
    return signs(m) == (1 << WIDTH) - 1;
}

/* `yes` where the mask is set, else `no`. */
static inline lanes chosen(mask m, lanes yes, lanes no)
{
#if WIDTH == 8
    return (lanes)((m & (mask)yes) | (~m & (mask)no));
#else
    return (lanes)_mm256_blendv_pd((__m256d)no, (__m256d)yes, (__m256d)m);
#endif
}

static inline lanes sqrt_in_lanes(lanes x)
{
    return (lanes)PACKED(sqrt)((packed)x);
}

static inline lanes floor_in_lanes(lanes x)
{
    return (lanes)PACKED(floor)((packed)x);
}

static inline lanes fabs_in_lanes(lanes x)
{
    return (lanes)PACKED(andnot)((packed)all_lanes(-0.0), (packed)x);
}

/* A size with the sign of x. */
static inline lanes with_sign(lanes size, lanes x)
{
    return (lanes)PACKED(or)((packed)size, PACKED(and)((packed)all_lanes(-0.0), (packed)x));
}

/* If not all values are for vectors, which is rare, each car's is computed by itself. */
#define UNLESS(m) if (__builtin_expect(!are_all(m), 0)) EACH_LANE(k)

static const double rounding = 6755399441055744.0; /* 1.5 2^52: the bits of a sum with it end with the whole number */

/* The nearest whole number, of at most 2^50; the last bits of the other are the same. */
static inline lanes nearest(lanes x, mask *bits)
{
    const lanes shifted = x + rounding;
    *bits = (mask)shifted;
    return shifted - rounding;
}

static inline lanes whole(mask number)
{
    return (lanes)(number + (mask)all_lanes(rounding)) - rounding;
}

/* The sine of x and so many quarters of a turn. The polynomials, as all below, are those of fdlibm. */
static ALWAYS lanes sine(lanes x, int quarters)
{
    mask quarter;
    const lanes n = nearest(0.6366197723675814 * x, &quarter);
    const lanes r = (x - 1.5707963267948966 * n) - 6.123233995736766e-17 * n, z = r * r, w = z * z;
    const lanes s = r + r * z * (-0.16666666666666632 + w * (-0.0001984126982985795 + w * -2.5050760253406863e-08) + z *
        (0.00833333333332249 + w * (2.7557313707070068e-06 + w * 1.58969099521155e-10)));
    const lanes c = 1.0 - z * (0.5 - z * (0.0416666666666666 + w * (2.480158728947673e-05 + w * 2.087572321298175e-09) +
        z * (-0.001388888888887411 + w * (-2.7557314351390663e-07 + w * -1.1359647557788195e-11))));
    quarter += quarters;
    lanes found = (lanes)((mask)chosen(-(quarter & 1), c, s) ^ (quarter & 2) << 62);
    UNLESS(fabs_in_lanes(x) < 1e9) found[k] = quarters ? cos(x[k]) : sin(x[k]);
    return found;
}

static inline lanes sin_in_lanes(lanes x)
{
    return sine(x, 0);
}

static inline lanes cos_in_lanes(lanes x)
{
    return sine(x, 1);
}

static ALWAYS lanes atan_in_lanes(lanes x)
{
    const lanes size = fabs_in_lanes(x), one = all_lanes(1.0), none = {0};
    const mask some = size > 0.41421356237309503, most = size > 2.414213562373095; /* of pi/8, of 3 pi/8 */
    const lanes t = chosen(most, -one, size - chosen(some, one, none)) /
        chosen(most, size, one + chosen(some, size, none));
    const lanes z = t * t, w = z * z;
    const lanes even = 0.3333333333333293 + w * (0.14285714272503466 + w * (0.09090887133436507 + w *
        (0.06661073137387531 + w * (0.049768779946159324 + w * 0.016285820115365782))));
    const lanes odd = -0.19999999999876483 + w * (-0.11111110405462356 + w * (-0.0769187620504483 + w *
        (-0.058335701337905735 + w * -0.036531572744216916)));
    const lanes part = t - t * z * (even + z * odd);
    const lanes before = chosen(some, all_lanes(0.7853981633974483), none);
    return with_sign(chosen(most, all_lanes(1.5707963267948966), before) + part, x);
}

/* Two numbers whose ratio is the exponential of x, which is at most 700 and at least -700. */
static ALWAYS lanes exponential(lanes x, lanes *under)
{
    mask power;
    const lanes n = nearest(1.4426950408889634 * x, &power);
    const lanes r = (x - 0.6931471803691238 * n) - 1.9082149292705877e-10 * n, z = r * r;
    *under = 2.0 - r + z * (0.16666666666666602 + z * (-0.0027777777777015593 + z * (6.613756321437934e-05 + z *
        (-1.6533902205465252e-06 + z * 4.1381367970572385e-08))));
    return (lanes)((mask)(*under + 2.0 * r) + (power << 52));
}

/* Of a car that rolls what has tanh is where that is 1. */
static ALWAYS lanes tanh_in_lanes(lanes x)
{
    const lanes size = fabs_in_lanes(x), most = all_lanes(20.0);
    lanes found = all_lanes(1.0);
    if (!are_all(size >= most)) {
        lanes under;
        const lanes over = exponential(2.0 * chosen(size > most, most, size), &under);
        found = (over - under) / (over + under);
    }
    return with_sign(found, x);
}

static ALWAYS lanes exp_in_lanes(lanes x)
{
    lanes under;
    const lanes over = exponential(x, &under);
    lanes found = over / under;
    UNLESS(fabs_in_lanes(x) < 700.0) found[k] = exp(x[k]);
    return found;
}

static ALWAYS lanes log_in_lanes(lanes x)
{
    const mask power = ((mask)x - (mask)all_lanes(0.7071067811865476)) >> 52;
    const lanes n = whole(power), f = (lanes)((mask)x - (power << 52)) - 1.0;
    const lanes s = f / (2.0 + f), z = s * s, half = 0.5 * f * f;
    const lanes R = z * (0.6666666666666735 + z * (0.3999999999940942 + z * (0.2857142874366239 + z *
        (0.22222198432149784 + z * (0.1818357216161805 + z * (0.15313837699209373 + z * 0.14798198605116586))))));
    lanes found = n * 0.6931471803691238 - ((half - (s * (half + R) + n * 1.9082149292705877e-10)) - f);
    UNLESS((x > 1e-300) & (x < 1e300)) found[k] = log(x[k]);
    return found;
}

static inline lanes square_in_lanes(lanes x)
{
    return x * x;
}

static inline lanes sign_of_in_lanes(lanes x)
{
    return chosen(x > 0.0, all_lanes(1.0), chosen(x < 0.0, all_lanes(-1.0), all_lanes(0.0)));
}

/* The same as modulo of operators.h. The multiple of y nearest to x may be the one beside it; what x is off from it is
exact, as what is multiplied and subtracted is rounded once. */
static ALWAYS lanes modulo_in_lanes(lanes x, lanes y)
{
    mask bits;
    const lanes quotient = x * (1.0 / y), none = {0};
    lanes rest = x - nearest(quotient, &bits) * y;
    rest = rest + chosen(rest < 0.0, y, none);
    UNLESS((y > 0.0) & (fabs_in_lanes(quotient) < 1125899906842624.0)) rest[k] = modulo(x[k], y[k]);
    return rest;
}

/* The whole part of a position, not less than 0 and not more than that; of one that is not a number it is 0. */
static inline mask index_of(lanes position, int most)
{
    const lanes some = chosen(position >= 1.0, position, all_lanes(0.0));
    const lanes within = floor_in_lanes(chosen(some < (double)most, some, all_lanes(most)));
    return (mask)(within + rounding) - (mask)all_lanes(rounding);
}

static inline lanes element(const lanes *array, mask index)
{
    lanes found;
    EACH_LANE(k) found[k] = array[index[k]][k];
    return found;
}

#endif

/* The mode of a plant alone in which a torque of the motor shows most in its speed, by the rates of change that the
plant's FMU gives in model exchange: fmus/building/oscillation.py, which tells what is done, for a page. */
#include <complex.h>
#include <float.h>

typedef double complex number;

enum { MOST_STATES = 40, MOST_SWEEPS = 60 };
#define MOVE 1e-6 /* STEP in oscillation.py */
#define CHANGE 0.5 /* of the torque to either side, in N.m */
#define CLOSE 1e-6 /* to a pole, over it */

static number work[MOST_STATES][MOST_STATES];

static double larger_part(number z)
{
    return fabs(creal(z)) + fabs(cimag(z));
}

static void swap(number *one, number *other)
{
    const number kept = *one;
    *one = *other;
    *other = kept;
}

/* A similar matrix in `work` with zeros below its first subdiagonal, by elimination. */
static void make_hessenberg(size_t n)
{
    for (size_t m = 1; m + 1 < n; m++) {
        size_t pivot = m;
        for (size_t i = m + 1; i < n; i++)
            if (larger_part(work[i][m - 1]) > larger_part(work[pivot][m - 1]))
                pivot = i;
        if (work[pivot][m - 1] == 0.0)
            continue;
        for (size_t j = 0; j < n; j++)
            swap(&work[pivot][j], &work[m][j]);
        for (size_t i = 0; i < n; i++)
            swap(&work[i][pivot], &work[i][m]);
        for (size_t i = m + 1; i < n; i++) {
            const number y = work[i][m - 1] / work[m][m - 1];
            for (size_t j = 0; j < n; j++)
                work[i][j] -= y * work[m][j];
            for (size_t k = 0; k < n; k++)
                work[k][m] += y * work[k][i];
        }
    }
}

/* A sweep of the shifted QR algorithm over the rows first to last of `work`, by rotations. */
static void sweep(size_t first, size_t last, number shift)
{
    double c[MOST_STATES];
    number s[MOST_STATES];
    for (size_t k = first; k <= last; k++)
        work[k][k] -= shift;
    for (size_t k = first; k < last; k++) {
        const number a = work[k][k], b = work[k + 1][k];
        const double length = hypot(cabs(a), cabs(b));
        c[k] = length > 0.0 ? cabs(a) / length : 1.0;
        s[k] = length > 0.0 ? (cabs(a) > 0.0 ? a / cabs(a) : 1.0) * conj(b) / length : 0.0;
        for (size_t j = k; j <= last; j++) {
            const number upper = work[k][j], lower = work[k + 1][j];
            work[k][j] = c[k] * upper + s[k] * lower;
            work[k + 1][j] = c[k] * lower - conj(s[k]) * upper;
        }
    }
    for (size_t k = first; k < last; k++)
        for (size_t i = first; i <= k + 1; i++) {
            const number left = work[i][k], right = work[i][k + 1];
            work[i][k] = c[k] * left + conj(s[k]) * right;
            work[i][k + 1] = c[k] * right - s[k] * left;
        }
    for (size_t k = first; k <= last; k++)
        work[k][k] += shift;
}

/* That of the two eigenvalues of the last two rows which is nearer to the last number. */
static number shift_of(size_t last)
{
    const number a = work[last - 1][last - 1], d = work[last][last], half = 0.5 * (a - d);
    const number root = csqrt(half * half + work[last - 1][last] * work[last][last - 1]);
    const number one = half + root, other = half - root;
    return d + (cabs(one) < cabs(other) ? one : other);
}

/* The eigenvalues of `work`; 0 if they are not found. */
static int find_poles(size_t n, number poles[])
{
    make_hessenberg(n);
    size_t sweeps = 0;
    for (size_t left = n; left > 0;) {
        const size_t last = left - 1;
        size_t first = last;
        for (; first > 0; first--)
            if (cabs(work[first][first - 1]) <= DBL_EPSILON * (cabs(work[first][first]) + cabs(work[first - 1][first - 1])))
                break;
        if (first == last) {
            poles[last] = work[last][last];
            left--;
            sweeps = 0;
        } else if (sweeps++ == MOST_SWEEPS) {
            return 0;
        } else {
            sweep(first, last, sweeps % 10 ? shift_of(last) : cabs(work[last][last - 1]) + work[last][last]);
        }
    }
    return 1;
}

/* Solves (s - A) x = b in `work`; x takes the place of b. */
static void solve(size_t n, const double A[][MOST_STATES], number s, number b[])
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            work[i][j] = (i == j ? s : 0.0) - A[i][j];
    for (size_t k = 0; k < n; k++) {
        size_t pivot = k;
        for (size_t i = k + 1; i < n; i++)
            if (larger_part(work[i][k]) > larger_part(work[pivot][k]))
                pivot = i;
        for (size_t j = 0; j < n; j++)
            swap(&work[pivot][j], &work[k][j]);
        swap(&b[pivot], &b[k]);
        for (size_t i = k + 1; i < n; i++) {
            const number y = work[i][k] / work[k][k];
            for (size_t j = k; j < n; j++)
                work[i][j] -= y * work[k][j];
            b[i] -= y * b[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++)
            b[k] -= work[k][j] * b[j];
        b[k] /= work[k][k];
    }
}

/* How much of the response of a state to B is that of a pole: its residue, from the response close to it. */
static double share(size_t n, const double A[][MOST_STATES], const double B[], size_t state, number pole)
{
    number response[MOST_STATES];
    for (size_t k = 0; k < n; k++)
        response[k] = B[k];
    solve(n, A, pole * (1.0 + CLOSE), response);
    return cabs(response[state] * pole * CLOSE);
}

/* The frequency in Hz; 0 if there is none. */
static double frequency_of(size_t n, const double A[][MOST_STATES], const double B[], size_t state)
{
    number poles[MOST_STATES];
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            work[i][j] = A[i][j];
    if (!find_poles(n, poles))
        return 0.0;
    double most = 0.0, found = 0.0;
    for (size_t k = 0; k < n; k++)
        if (cimag(poles[k]) > 0.0) {
            const double shown = share(n, A, B, state, poles[k]);
            if (shown > most) {
                most = shown;
                found = cabs(poles[k]) / (2.0 * acos(-1.0));
            }
        }
    return found;
}

static fmi2Component exchanging[sizeof fmus / sizeof *fmus];

/* Brings a plant for model exchange to where its parameters can be set. */
KEPT fmi2Status begin_mode(uint32_t number)
{
    call_record = &record;
    if (exchanging[number])
        return fmus[number].reset(exchanging[number]);
    exchanging[number] = fmus[number].instantiate("mode", fmi2ModelExchange, fmus[number].guid, "", &callbacks, 0, 1);
    return exchanging[number] ? fmi2OK : fmi2Error;
}

/* Sets a parameter, as `set` does. */
KEPT fmi2Status set_of_mode(uint32_t number, int type, fmi2ValueReference reference, double value)
{
    return set_in(&fmus[number], exchanging[number], type, reference, value);
}

static int got_rates(const Fmu *fmu, fmi2Component c, const double x[], size_t n, double rates[])
{
    return fmu->set_states(c, x, n) == fmi2OK && fmu->get_rates(c, rates, n) == fmi2OK;
}

/* The frequency of the mode in Hz with the torque in N.m at the input of that reference; 0 if there is none. */
KEPT double mode_frequency(uint32_t number, size_t n, size_t state, fmi2ValueReference input, double torque)
{
    static double A[MOST_STATES][MOST_STATES];
    double x[MOST_STATES], B[MOST_STATES], up[MOST_STATES], down[MOST_STATES];
    const Fmu *fmu = &fmus[number];
    const fmi2Component c = exchanging[number];
    fmi2EventInfo info;
    if (n > MOST_STATES || fmu->set_real(c, &input, 1, &torque) != fmi2OK
        || fmu->set_up(c, 0, 0.0, 0.0, 0, 0.0) != fmi2OK || fmu->enter(c) != fmi2OK || fmu->leave(c) != fmi2OK
        || fmu->discrete(c, &info) != fmi2OK || fmu->integrate(c) != fmi2OK || fmu->get_states(c, x, n) != fmi2OK)
        return 0.0;
    for (size_t k = 0; k < n; k++) {
        const double here = x[k];
        x[k] = here + MOVE;
        int good = got_rates(fmu, c, x, n, up);
        x[k] = here - MOVE;
        good = good && got_rates(fmu, c, x, n, down);
        x[k] = here;
        if (!good)
            return 0.0;
        for (size_t i = 0; i < n; i++)
            A[i][k] = (up[i] - down[i]) / (2.0 * MOVE);
    }
    const double more = torque + CHANGE, less = torque - CHANGE;
    if (fmu->set_real(c, &input, 1, &more) != fmi2OK || !got_rates(fmu, c, x, n, up)
        || fmu->set_real(c, &input, 1, &less) != fmi2OK || !got_rates(fmu, c, x, n, down))
        return 0.0;
    for (size_t i = 0; i < n; i++)
        B[i] = up[i] - down[i];
    return frequency_of(n, (const double(*)[MOST_STATES])A, B, state);
}

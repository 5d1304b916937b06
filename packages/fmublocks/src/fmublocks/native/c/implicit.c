/* Steps of a linearly implicit method, for where a block is stiff: they damp what they do not resolve. The same as
implicit.py, operation by operation; only here inputs may move, and the derivative with the time. */
#include "implicit.h"
#include "rodas.h"
#include "shared.h"

#include <math.h>
#include <string.h>

typedef struct {
    Vector rows[STATES];
    int order[STATES];
} Matrix;

/* Column j of J holds what state j moves. */
static void jacobian(const Problem *problem, const Start *from, Vector J[STATES])
{
    Vector moved, there;
    memcpy(moved, from->x, sizeof moved);
    for (int j = 0; j < STATES; j++) {
        const double x = from->x[j];
        moved[j] = x + DIFFERENCE * (fabs(x) + small[j]);
        const double by = moved[j] - x;
        rate(problem, from->t, moved, there);
        for (int n = 0; n < STATES; n++)
            J[n][j] = (there[n] - from->dx[n]) / by;
        moved[j] = x;
    }
}

/* The rate at which the derivative moves with the inputs. */
static void drift(const Problem *problem, const Start *from, double h, Vector df)
{
    Vector there;
    rate(problem, from->t + DIFFERENCE * h, from->x, there);
    for (int n = 0; n < STATES; n++)
        df[n] = (there[n] - from->dx[n]) / (DIFFERENCE * h);
}

/* Gaussian elimination with row pivoting, in place, of the matrix with that added to its diagonal; 0 if the matrix is
singular. */
static int factorise(Matrix *matrix, double diagonal)
{
    Vector *rows = matrix->rows, swapped;
    for (int n = 0; n < STATES; n++) {
        rows[n][n] += diagonal;
        matrix->order[n] = n;
    }
    for (int k = 0; k < STATES; k++) {
        int pivot = k;
        for (int i = k; i < STATES; i++)
            if (fabs(rows[i][k]) > fabs(rows[pivot][k]))
                pivot = i;
        if (pivot != k) {
            const int taken = matrix->order[k];
            matrix->order[k] = matrix->order[pivot];
            matrix->order[pivot] = taken;
            memcpy(swapped, rows[k], sizeof swapped);
            memcpy(rows[k], rows[pivot], sizeof swapped);
            memcpy(rows[pivot], swapped, sizeof swapped);
        }
        const real *top = rows[k];
        if (top[k] == 0.0)
            return 0;
        for (int i = k + 1; i < STATES; i++) {
            real *row = rows[i];
            if (row[k] == 0.0)
                continue;
            row[k] = row[k] / top[k];
            for (int j = k + 1; j < STATES; j++)
                row[j] -= row[k] * top[j];
        }
    }
    return 1;
}

static void solve(const Matrix *matrix, const Vector right, Vector result)
{
    for (int n = 0; n < STATES; n++)
        result[n] = right[matrix->order[n]];
    for (int i = 0; i < STATES; i++)
        for (int j = 0; j < i; j++)
            result[i] -= matrix->rows[i][j] * result[j];
    for (int i = STATES - 1; i >= 0; i--) {
        for (int j = i + 1; j < STATES; j++)
            result[i] -= matrix->rows[i][j] * result[j];
        result[i] /= matrix->rows[i][i];
    }
}

static double weighted(const double weights[], Vector found[], int count, int n)
{
    double total = 0.0;
    for (int j = 0; j < count; j++)
        total += weights[j] * found[j][n];
    return total;
}

/* The state after one step, and its error in units of what is tolerated. */
static double try_step(const Problem *problem, const Start *from, Vector J[STATES], double h, Vector end)
{
    Matrix matrix;
    Vector at, dx, df, right, found[STAGES];
    for (int n = 0; n < STATES; n++)
        for (int j = 0; j < STATES; j++)
            matrix.rows[n][j] = -J[n][j];
    if (!factorise(&matrix, 1.0 / (h * GAMMA)))
        return INFINITY;
    memcpy(at, from->x, sizeof at);
    memcpy(dx, from->dx, sizeof dx);
    if (problem->du)
        drift(problem, from, h, df);
    for (int i = 0; i < STAGES; i++) {
        if (i > 0) {
            for (int n = 0; n < STATES; n++)
                at[n] = from->x[n] + weighted(A[i], found, i, n);
            rate(problem, from->t + C[i] * h, at, dx);
        }
        for (int n = 0; n < STATES; n++)
            right[n] = dx[n] + weighted(G[i], found, i, n) / h;
        for (int n = 0; problem->du && n < STATES; n++)
            right[n] += D[i] * h * df[n];
        solve(&matrix, right, found[i]);
    }
    double total = 0.0;
    for (int n = 0; n < STATES; n++) {
        const double last = found[STAGES - 1][n];
        end[n] = at[n] + last;
        const double e = last / (TOLERANCE * (fmax(fabs(from->x[n]), fabs(end[n])) + small[n]));
        total += e * e;
    }
    return sqrt(total / (double)STATES);
}

/* How fast state n changes for its size. */
static double pace(const Start *from, int n)
{
    return fabs(from->dx[n]) / (fabs(from->x[n]) + small[n]);
}

int fastest(const Start *from)
{
    int found = 0;
    for (int n = 0; n < STATES; n++)
        if (pace(from, n) > pace(from, found))
            found = n;
    return found;
}

int integrate_stiff(const Problem *problem, Start *from, double duration)
{
    Vector J[STATES], end;
    double left = duration, length = duration;
    jacobian(problem, from, J);
    for (int steps = 0; steps < MOST_STEPS; steps++) {
        *problem->work += IMPLICIT_WORK;
        const double error = try_step(problem, from, J, length, end);
        if (error <= 1.0) {
            left -= length;
            begin_at(problem, from->t + length, end, from);
            if (left <= 0.0)
                return 0;
            jacobian(problem, from, J);
        } else if (length < SHORTEST_STEP) {
            break;
        }
        length = fmin(length * change(error, 2), left);
    }
    return 1 + fastest(from);
}

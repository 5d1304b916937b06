/* The controller on its own: each line of standard input is one sample of its inputs, in the order of their struct;
one line of outputs each comes out. */
#include "damping_controller.h"

#include <stdio.h>

enum {
    INPUTS = sizeof(DampingControllerInput) / sizeof(REAL),
    OUTPUTS = sizeof(DampingControllerOutput) / sizeof(REAL)
};

static int read_input(DampingControllerInput *u)
{
    REAL *value = (REAL *)u;
    for (int k = 0; k < INPUTS; k++) {
        double number;
        if (scanf("%lf", &number) != 1)
            return 0;
        value[k] = (REAL)number;
    }
    return 1;
}

static void write_output(const DampingControllerOutput *y)
{
    const REAL *value = (const REAL *)y;
    for (int k = 0; k < OUTPUTS; k++)
        printf("%.17g%c", (double)value[k], k + 1 < OUTPUTS ? ' ' : '\n');
}

int main(void)
{
    const DampingControllerParameters *p = &damping_controller_parameters;
    DampingControllerInput u;
    DampingControllerOutput y;
    DampingControllerState states[2], *x = &states[0], *next = &states[1];
    if (!read_input(&u))
        return 1;
    damping_controller_start(&u, p, x);
    do {
        damping_controller_output(x, &u, p, &y);
        write_output(&y);
        damping_controller_update(x, &u, p, next);
        DampingControllerState *past = x;
        x = next;
        next = past;
    } while (read_input(&u));
    return 0;
}

/* An example of a main on a board: a timer's interrupt runs the controller at every sample, under a watchdog, with
stand-ins for the bus and for the torque interface, over a background that now and then shuts interrupts out. After
SAMPLES samples it sends what it has seen, and ends. */
#include "board.h"
#include "controller.h"

enum { SAMPLES = 5000, CLOCK = 25000000, BUS_CYCLE = 10, BUSY = 100 };
enum { TIMER_NUMBER = 8, TIMER_ON = 9, WATCHDOG_RESETS = 3, WATCHDOG_PERIODS = 2 };

/* CMSDK timer 0 and watchdog of the MPS2, and the interrupt controller of the processor. */
static volatile struct {
    uint32_t control, value, reload, interrupt;
} *const timer = (void *)0x40000000;
static volatile struct {
    uint32_t load, value, control, clear;
} *const watchdog = (void *)0x40008000;
static volatile uint32_t *const interrupt_enable = (volatile uint32_t *)0xE000E100;

static const uint32_t PERIOD = (uint32_t)(CONTROLLER_SAMPLE_TIME * CLOCK + 0.5f);

/* What is sent at the end; times are in ticks of the timer, of which a sample has `period`. */
static volatile struct {
    uint32_t samples, missed, period, latency, response, watchdog;
} seen;

static ControllerState states[2], *x = &states[0], *next = &states[1];
static ControllerInput u;
static ControllerOutput y;

/* A stand-in for sensors and bus: a mass that the torque moves, and a message every BUS_CYCLE samples. */
static void receive(void)
{
    u.T_driver = seen.samples % 1000 < 500 ? 80.0f : -10.0f;
    u.T_mot_est = y.T_ref;
    u.omega_1_meas += y.T_ref * CONTROLLER_SAMPLE_TIME / 2.0f;
    if (seen.samples % BUS_CYCLE == 0) {
        u.omega_2_can = u.omega_1_meas;
        u.counter = u.counter < 255.0f ? u.counter + 1.0f : 0.0f;
    }
}

/* A stand-in for the torque interface: what it would be given, and when. */
static volatile float demanded;

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

void timer_interrupt(void)
{
    seen.latency = larger(seen.latency, PERIOD - 1 - timer->value);
    timer->interrupt = 1;
    controller_output(x, &u, &controller_parameters, &y);
    demanded = y.T_ref;
    receive();
    controller_update(x, &u, &controller_parameters, next);
    ControllerState *past = x;
    x = next;
    next = past;
    seen.watchdog = larger(seen.watchdog, WATCHDOG_PERIODS * PERIOD - watchdog->value);
    watchdog->clear = 1;
    seen.response = larger(seen.response, PERIOD - 1 - timer->value);
    seen.missed += timer->interrupt;
    seen.samples++;
}

/* Other work, which for BUSY rounds of a loop must not be interrupted. */
static void background(void)
{
    __asm__ volatile("cpsid i" ::: "memory");
    for (volatile uint32_t k = 0; k < BUSY; k++)
        ;
    __asm__ volatile("cpsie i" ::: "memory");
}

int main(void)
{
    u.valid = 1.0f;
    u.enable = 1.0f;
    controller_start(&u, &controller_parameters, x);
    seen.period = PERIOD;
    watchdog->load = WATCHDOG_PERIODS * PERIOD;
    watchdog->control = WATCHDOG_RESETS;
    timer->reload = timer->value = PERIOD - 1;
    *interrupt_enable = 1u << TIMER_NUMBER;
    timer->control = TIMER_ON;
    while (seen.samples < SAMPLES)
        background();
    timer->control = 0;
    board_send((const void *)&seen, sizeof seen);
    return 0;
}

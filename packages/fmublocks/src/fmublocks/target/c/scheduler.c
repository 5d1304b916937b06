/* An example of a main on a board: a timer's interrupt runs the controller at every sample, under a watchdog, with
stand-ins for the bus and for the torque interface, over a background that now and then shuts interrupts out. After
SAMPLES samples it sends what it has seen, and ends. */
#include "board.h"
#include "controller.h"

static const uint32_t SAMPLES = 5000;
static const uint32_t BUS_CYCLE = 10;
static const uint32_t BUSY = 100;
static const uint32_t DRIVER_CYCLE = 1000;

static const uint32_t TIMER_INTERRUPT = 0x100; /* number 8 */
static const uint32_t TIMER_ON = 9;
static const uint32_t WATCHDOG_RESETS = 3;
static const uint32_t WATCHDOG_PERIODS = 2;

/* CMSDK timer 0 and watchdog of the MPS2, and the interrupt controller of the processor. */
typedef struct {
    uint32_t control;
    uint32_t value;
    uint32_t reload;
    uint32_t interrupt;
} Timer;
static volatile Timer *const timer = (volatile Timer *)0x40000000u;

typedef struct {
    uint32_t load;
    uint32_t value;
    uint32_t control;
    uint32_t clear;
} Watchdog;
static volatile Watchdog *const watchdog = (volatile Watchdog *)0x40008000u;

static volatile uint32_t *const interrupt_enable = (volatile uint32_t *)0xE000E100u;

/* Ticks of the timer, at 25 MHz, in a sample. */
static const float TICKS = (CONTROLLER_SAMPLE_TIME * 25.0e6f) + 0.5f;

/* What is sent at the end; times are in ticks of the timer, of which a sample has `period`. */
static volatile struct {
    uint32_t samples;
    uint32_t missed;
    uint32_t period;
    uint32_t latency;
    uint32_t response;
    uint32_t watchdog;
} seen;

static ControllerState states[2];
static ControllerState *x = &states[0];
static ControllerState *next = &states[1];
static ControllerInput u;
static ControllerOutput y;

/* A stand-in for sensors and bus: a mass that the torque moves, and a message every BUS_CYCLE samples. */
static void receive(void)
{
    u.T_driver = ((2u * (seen.samples % DRIVER_CYCLE)) < DRIVER_CYCLE) ? 80.0f : -10.0f;
    u.T_mot_est = y.T_ref;
    u.omega_1_meas += (y.T_ref * CONTROLLER_SAMPLE_TIME) / 2.0f;
    if ((seen.samples % BUS_CYCLE) == 0u) {
        u.omega_2_can = u.omega_1_meas;
        u.counter = (u.counter < 255.0f) ? (u.counter + 1.0f) : 0.0f;
    }
}

/* Ticks since the timer began its period. */
static uint32_t elapsed(void)
{
    return (seen.period - 1u) - timer->value;
}

/* A stand-in for the torque interface: what it would be given, and when. */
static volatile float demanded;

static uint32_t larger(uint32_t a, uint32_t b)
{
    return (a > b) ? a : b;
}

void timer_interrupt(void)
{
    seen.latency = larger(seen.latency, elapsed());
    timer->interrupt = 1;
    controller_output(x, &u, &controller_parameters, &y);
    demanded = y.T_ref;
    receive();
    controller_update(x, &u, &controller_parameters, next);
    ControllerState *past = x;
    x = next;
    next = past;
    seen.watchdog = larger(seen.watchdog, (WATCHDOG_PERIODS * seen.period) - watchdog->value);
    watchdog->clear = 1;
    seen.response = larger(seen.response, elapsed());
    seen.missed += timer->interrupt;
    seen.samples++;
}

/* Other work, which for BUSY rounds of a loop must not be interrupted. */
static void background(void)
{
    __asm__ volatile("cpsid i" ::: "memory");
    volatile uint32_t rounds = 0;
    while (rounds < BUSY) {
        rounds++;
    }
    __asm__ volatile("cpsie i" ::: "memory");
}

int main(void)
{
    u.valid = 1.0f;
    u.enable = 1.0f;
    controller_start(&u, &controller_parameters, x);
    seen.period = (uint32_t)TICKS;
    watchdog->load = WATCHDOG_PERIODS * seen.period;
    watchdog->control = WATCHDOG_RESETS;
    timer->value = seen.period - 1u;
    timer->reload = seen.period - 1u;
    *interrupt_enable = TIMER_INTERRUPT;
    timer->control = TIMER_ON;
    while (seen.samples < SAMPLES) {
        background();
    }
    timer->control = 0;
    board_send((const void *)&seen, sizeof seen);
    return 0;
}

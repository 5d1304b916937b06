/* The board MPS2 with the image AN386, a Cortex-M4 with its floating-point unit, as QEMU emulates it. The link is
standard input and output of the emulator, over semihosting; SysTick runs with the emulator's instruction counter. */
#include "board.h"

#include <stddef.h>

/* From the linker's script. */
extern uint32_t stack_limit;
extern uint32_t stack_top;
extern uint32_t data_load;
extern uint32_t data_start;
extern uint32_t data_end;
extern uint32_t bss_start;
extern uint32_t bss_end;

int main(void);
void reset(void);

static const int32_t SYS_OPEN = 0x01;
static const int32_t SYS_WRITE = 0x05;
static const int32_t SYS_READ = 0x06;
static const int32_t SYS_EXIT_EXTENDED = 0x20;

static const uintptr_t READ_BINARY = 1;
static const uintptr_t WRITE_BINARY = 5;
static const uintptr_t APPLICATION_EXIT = 0x20026;
static const uintptr_t CRASHED = 3;

/* SysTick counts down 24 bits at 25 MHz; with -icount shift=7 an instruction takes 128 ns, which is 3.2 ticks. */
static const uint32_t SYSTICK_MASK = 0xFFFFFF;
static const uint32_t TICKS = 16;
static const uint32_t INSTRUCTIONS = 5;

static volatile uint32_t *const CPACR = (volatile uint32_t *)0xE000ED88u;
static volatile uint32_t *const SYST_CSR = (volatile uint32_t *)0xE000E010u;
static volatile uint32_t *const SYST_RVR = (volatile uint32_t *)0xE000E014u;
static volatile uint32_t *const SYST_CVR = (volatile uint32_t *)0xE000E018u;

static const uint32_t FLOATING_POINT = 0x00F00000; /* both coprocessors of it, fully */

static const uint32_t UNUSED = 0xA5A5A5A5u;

static uintptr_t input;
static uintptr_t output;

static int32_t semihosting(int32_t operation, const uintptr_t *arguments)
{
    register int32_t r0 __asm__("r0") = operation;
    register const uintptr_t *r1 __asm__("r1") = arguments;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static uintptr_t opened(const char *path, uintptr_t length, uintptr_t mode)
{
    return (uintptr_t)semihosting(SYS_OPEN, (const uintptr_t[]){(uintptr_t)path, mode, length});
}

static void leave(uintptr_t code)
{
    for (;;) {
        (void)semihosting(SYS_EXIT_EXTENDED, (const uintptr_t[]){APPLICATION_EXIT, code});
    }
}

bool board_receive(void *bytes, uint32_t count)
{
    uint8_t *const to = bytes;
    uint32_t done = 0;
    bool open = true;
    while (open && (done < count)) {
        const uint32_t wanted = count - done;
        const uint32_t left = (uint32_t)semihosting(SYS_READ, (const uintptr_t[]){input, (uintptr_t)&to[done], wanted});
        open = left < wanted;
        done += wanted - left;
    }
    return open;
}

void board_send(const void *bytes, uint32_t count)
{
    (void)semihosting(SYS_WRITE, (const uintptr_t[]){output, (uintptr_t)bytes, count});
}

uint32_t board_count(void)
{
    static uint32_t last;
    static uint32_t ticks;
    const uint32_t now = *SYST_CVR;
    ticks += (last - now) & SYSTICK_MASK;
    last = now;
    return ticks * INSTRUCTIONS / TICKS;
}

uint32_t board_stack(void)
{
    volatile uint32_t *const here = __builtin_frame_address(0);
    volatile uint32_t *lowest = &stack_limit;
    while ((lowest != here) && (*lowest == UNUSED)) {
        lowest++;
    }
    volatile uint32_t *word = lowest;
    while (word != here) {
        *word = UNUSED; /* volatile: no function may be called for it, whose own stack it would paint */
        word++;
    }
    return (uint32_t)((uintptr_t)here - (uintptr_t)lowest);
}

static void fault(void)
{
    leave(CRASHED);
}

/* Of the timer; a program that uses it has a function of its own of this name. */
__attribute__((weak)) void timer_interrupt(void)
{
    fault();
}

void reset(void)
{
    *CPACR |= FLOATING_POINT;
    __asm__ volatile("dsb\n isb");
    const uint32_t *from = &data_load;
    uint32_t *to = &data_start;
    while (to != &data_end) {
        *to = *from;
        to++;
        from++;
    }
    to = &bss_start;
    while (to != &bss_end) {
        *to = 0;
        to++;
    }
    *SYST_RVR = SYSTICK_MASK;
    *SYST_CVR = 0;
    *SYST_CSR = 5; /* on, by the processor's clock, without interrupts */
    input = opened("/dev/stdin", 10, READ_BINARY);
    output = opened("/dev/stdout", 11, WRITE_BINARY);
    leave((uintptr_t)main());
}

typedef void (*Vector)(void);

/* Stack, reset, the faults, and interrupt 8, that of the timer. */
__attribute__((section(".vectors"), used)) static const struct VectorTable {
    uint32_t *stack;
    Vector vectors[24];
} table = {
    .stack = &stack_top,
    .vectors =
        {
            [0] = reset,
            [1] = fault,
            [2] = fault,
            [3] = fault,
            [4] = fault,
            [5] = fault,
            [23] = timer_interrupt,
        },
};

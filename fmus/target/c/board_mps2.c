/* The board MPS2 with the image AN386, a Cortex-M4 with its floating-point unit, as QEMU emulates it. The link is
standard input and output of the emulator, over semihosting; SysTick runs with the emulator's instruction counter. */
#include "board.h"

#include <stddef.h>

/* From the linker's script. */
extern uint32_t stack_limit, stack_top, data_load, data_start, data_end, bss_start, bss_end;

int main(void);
void reset(void);
void timer_interrupt(void);

enum { SYS_OPEN = 0x01, SYS_WRITE = 0x05, SYS_READ = 0x06, SYS_EXIT_EXTENDED = 0x20 };
enum { READ_BINARY = 1, WRITE_BINARY = 5, APPLICATION_EXIT = 0x20026, CRASHED = 3 };

/* SysTick counts down 24 bits at 25 MHz; with -icount shift=7 an instruction takes 128 ns, which is 3.2 ticks. */
enum { SYSTICK_MASK = 0xFFFFFF, TICKS = 16, INSTRUCTIONS = 5 };

static volatile uint32_t *const CPACR = (volatile uint32_t *)0xE000ED88;
static volatile uint32_t *const SYST_CSR = (volatile uint32_t *)0xE000E010;
static volatile uint32_t *const SYST_RVR = (volatile uint32_t *)0xE000E014;
static volatile uint32_t *const SYST_CVR = (volatile uint32_t *)0xE000E018;

static const uint32_t UNUSED = 0xA5A5A5A5;

static uintptr_t input, output;

static int semihosting(int operation, const uintptr_t *arguments)
{
    register int r0 __asm__("r0") = operation;
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
    for (;;)
        (void)semihosting(SYS_EXIT_EXTENDED, (const uintptr_t[]){APPLICATION_EXIT, code});
}

int board_receive(void *bytes, uint32_t count)
{
    uint8_t *to = bytes;
    while (count > 0) {
        const uint32_t left = (uint32_t)semihosting(SYS_READ, (const uintptr_t[]){input, (uintptr_t)to, count});
        if (left >= count)
            return 0;
        to += count - left;
        count = left;
    }
    return 1;
}

void board_send(const void *bytes, uint32_t count)
{
    (void)semihosting(SYS_WRITE, (const uintptr_t[]){output, (uintptr_t)bytes, count});
}

uint32_t board_count(void)
{
    static uint32_t last, ticks;
    const uint32_t now = *SYST_CVR;
    ticks += (last - now) & SYSTICK_MASK;
    last = now;
    return ticks * INSTRUCTIONS / TICKS;
}

uint32_t board_stack(void)
{
    volatile uint32_t *const here = __builtin_frame_address(0), *lowest = &stack_limit;
    while (lowest < here && *lowest == UNUSED)
        lowest++;
    for (volatile uint32_t *word = lowest; word < here; word++)
        *word = UNUSED; /* volatile: no function may be called for it, whose own stack it would paint */
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
    *CPACR |= 0xFu << 20; /* the floating-point unit on */
    __asm__ volatile("dsb\n isb");
    for (uint32_t *to = &data_start, *from = &data_load; to < &data_end; to++, from++)
        *to = *from;
    for (uint32_t *to = &bss_start; to < &bss_end; to++)
        *to = 0;
    *SYST_RVR = SYSTICK_MASK;
    *SYST_CVR = 0;
    *SYST_CSR = 5; /* on, by the processor's clock, without interrupts */
    input = opened("/dev/stdin", 10, READ_BINARY);
    output = opened("/dev/stdout", 11, WRITE_BINARY);
    leave((uintptr_t)main());
}

typedef void (*Vector)(void);

/* Stack, reset, the faults, and interrupt 8, that of the timer. */
__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    Vector vectors[24];
} table = {&stack_top, {reset, fault, fault, fault, fault, fault, [23] = timer_interrupt}};

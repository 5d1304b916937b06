/* What a board supplies to the controller's program: the first four functions, and a start that calls main. */
#ifndef BOARD_H
#define BOARD_H

#include <stdbool.h>
#include <stdint.h>

/* Takes so many bytes from the link and waits for them. False: the link was closed. */
bool board_receive(void *bytes, uint32_t count);

/* Gives so many bytes to the link. */
void board_send(const void *bytes, uint32_t count);

/* Instructions executed, or cycles where they are what can be counted; runs on from any value and wraps. */
uint32_t board_count(void);

/* Bytes of stack that were used below the caller's since the last call. */
uint32_t board_stack(void);

/* What the interrupt of a timer calls, in a program that uses one. */
void timer_interrupt(void);

#endif

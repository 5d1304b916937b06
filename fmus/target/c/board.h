/* What a board supplies to the controller's program: these four functions, and a start that calls main. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Takes so many bytes from the link and waits for them. Returns 1, or 0 when the link was closed. */
int board_receive(void *bytes, uint32_t count);

/* Gives so many bytes to the link. */
void board_send(const void *bytes, uint32_t count);

/* Instructions executed, or cycles where they are what can be counted; runs on from any value and wraps. */
uint32_t board_count(void);

/* Bytes of stack that were used below the caller's since the last call. */
uint32_t board_stack(void);

#endif

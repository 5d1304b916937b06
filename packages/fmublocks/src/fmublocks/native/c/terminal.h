/* What is on its way between an FMU and a CAN bus: operations of FMI-LS-BUS 1.0 (low cut), one behind the other. */
#ifndef TERMINAL_H
#define TERMINAL_H

#include "frame.h"

#include <stdint.h>

/* Whole multiples of 8 bytes, as it is part of a saved state. */
typedef struct {
    double sent;     /* counter of the frame that was sent last */
    int64_t has_rx;  /* Rx_Clock is active */
    uint64_t tx_size;
    uint64_t rx_size;
    unsigned char tx[OPERATIONS_SIZE];
    unsigned char rx[OPERATIONS_SIZE];
} Terminal;

#endif

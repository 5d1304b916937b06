/* The terminal of a CAN bus: sends a frame whenever its counter has gone on, and answers what comes in. */
#include "instance.h"

#include <string.h>

enum { FORMAT_ERROR = 0x01, CAN_TRANSMIT = 0x10, CONFIGURATION = 0x40 };        /* operations */
enum { CAN_BAUDRATE = 1, ARBITRATION_LOST_BEHAVIOR = 4, BUFFER_AND_RETRANSMIT = 1 }; /* of a configuration */
enum { HEAD_SIZE = 8 };

static void append(Terminal *terminal, uint32_t number, int bytes)
{
    for (; bytes > 0; bytes--, number >>= 8)
        terminal->tx[terminal->tx_size++] = (unsigned char)(number & 0xFF);
}

/* Code and length of an operation, before its arguments; 0 if there is no room for it. */
static int begin(Terminal *terminal, uint32_t code, size_t arguments)
{
    if (terminal->tx_size + HEAD_SIZE + arguments > OPERATIONS_SIZE)
        return 0;
    append(terminal, code, 4);
    append(terminal, (uint32_t)(HEAD_SIZE + arguments), 4);
    return 1;
}

static void append_data(Terminal *terminal, const unsigned char data[], size_t size)
{
    append(terminal, (uint32_t)size, 2);
    memcpy(&terminal->tx[terminal->tx_size], data, size);
    terminal->tx_size += size;
}

void open_terminal(Memory *memory)
{
    Terminal *terminal = &memory->terminal;
    Output y;
    output(&memory->x, &memory->values.u, &memory->values.p, &y);
    terminal->sent = y.FRAME_COUNTER;
    begin(terminal, CONFIGURATION, 5);
    append(terminal, CAN_BAUDRATE, 1);
    append(terminal, BAUD_RATE, 4);
    begin(terminal, CONFIGURATION, 2);
    append(terminal, ARBITRATION_LOST_BEHAVIOR, 1);
    append(terminal, BUFFER_AND_RETRANSMIT, 1);
}

/* The signals one behind the other, the first bit of the first byte first. */
static void pack(const double counts[FRAME_SIGNALS], unsigned char data[FRAME_LENGTH])
{
    memset(data, 0, FRAME_LENGTH);
    for (unsigned k = 0, at = 0; k < FRAME_SIGNALS; k++)
        for (uint64_t bit = 0, count = (uint64_t)counts[k]; bit < frame_bits[k]; bit++, at++)
            data[at / 8] |= (unsigned char)((count >> bit & 1U) << at % 8);
}

int send_frame(Memory *memory)
{
    const Values *values = &memory->values;
    Terminal *terminal = &memory->terminal;
    double counts[FRAME_SIGNALS];
    unsigned char data[FRAME_LENGTH];
    if (values->y.FRAME_COUNTER == terminal->sent)
        return 1;
    if (!begin(terminal, CAN_TRANSMIT, 8 + FRAME_LENGTH))
        return 0;
    frame(&values->y, &values->p, counts);
    pack(counts, data);
    append(terminal, FRAME_IDENTIFIER, 4);
    append(terminal, 0, 2); /* no extended identifier, no remote frame */
    append_data(terminal, data, FRAME_LENGTH);
    terminal->sent = values->y.FRAME_COUNTER;
    return 1;
}

static uint32_t number_at(const unsigned char bytes[4])
{
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* Whether there is an operation of that code and length. */
static int is_known(uint32_t code, size_t length)
{
    static const struct {
        uint32_t code, least;
    } known[] = {
        {0x01, 10}, {0x10, 16}, {0x11, 17}, {0x12, 22}, {0x20, 12}, {0x30, 12}, {0x31, 15}, {0x40, 9}, {0x41, 9}, {0x42, 8}};
    for (unsigned k = 0; k < sizeof known / sizeof *known; k++)
        if (known[k].code == code)
            return length >= known[k].least;
    return 0;
}

/* Of what has come in nothing is meant for the FMU; what is no operation of CAN is sent back, if there is room. */
static void receive(Terminal *terminal)
{
    for (size_t at = 0, size; at < terminal->rx_size; at += size) {
        const unsigned char *bytes = &terminal->rx[at];
        const size_t left = terminal->rx_size - at;
        size = left < HEAD_SIZE ? 0 : number_at(&bytes[4]);
        const int whole = size >= HEAD_SIZE && size <= left;
        size = whole ? size : left;
        if ((!whole || !is_known(number_at(bytes), size)) && begin(terminal, FORMAT_ERROR, 2 + size))
            append_data(terminal, bytes, size);
    }
}

void update_terminal(Terminal *terminal)
{
    memset(terminal->tx, 0, sizeof terminal->tx);
    terminal->tx_size = 0;
    if (terminal->has_rx)
        receive(terminal);
    terminal->has_rx = 0;
}

Status check_terminal(const Instance *instance, const Terminal *terminal)
{
    const int good = terminal->tx_size <= OPERATIONS_SIZE && terminal->rx_size <= OPERATIONS_SIZE;
    return good ? OK : refuse(instance, DAMAGED_STATE);
}

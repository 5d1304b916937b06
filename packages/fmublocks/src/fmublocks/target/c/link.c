/* The controller behind a link. Every command, a letter and what belongs to it, is answered with the outputs, the
state and what the command took; all numbers are sent as they lie in memory. */
#include "board.h"
#include "controller.h"

enum {
    SIZES = 'i',      /* nothing: is answered with four sizes in bytes alone */
    START = 's',      /* inputs */
    UPDATE = 'u',     /* inputs */
    STATE = 'x',      /* the state, which becomes the present one */
    PARAMETERS = 'p', /* the parameters, which stay until others come */
    READ = 'r',       /* address and count: is answered with so many bytes from there alone */
    WRITE = 'w',      /* address, count and so many bytes, which are put there */
};

/* What the calibration engineer sets. */
static ControllerParameters calibration;

static ControllerState states[2];
static ControllerState *x = &states[0];
static ControllerState *next = &states[1];
static ControllerInput u;
static ControllerOutput y;

static void send_sizes(void)
{
    const uint32_t sizes[4] = {sizeof u, sizeof y, sizeof *x, sizeof calibration};
    board_send(sizes, sizeof sizes);
}

/* One sample: the next state becomes the present one, and its outputs are those that the motor gets. */
static void sample(void)
{
    controller_update(x, &u, &calibration, next);
    ControllerState *past = x;
    x = next;
    next = past;
    controller_output(x, &u, &calibration, &y);
}

static void start(void)
{
    controller_start(&u, &calibration, x);
    controller_output(x, &u, &calibration, &y);
}

/* Carries out what has come, and says what the controller took: instructions and bytes of stack. */
static void answer(void (*what)(void))
{
    uint32_t taken[2];
    (void)board_stack();
    const uint32_t first = board_count();
    const uint32_t second = board_count();
    what();
    taken[0] = board_count() - second - (second - first);
    taken[1] = board_stack();
    board_send(&y, sizeof y);
    board_send(x, sizeof *x);
    board_send(taken, sizeof taken);
}

static void outputs(void)
{
    controller_output(x, &u, &calibration, &y);
}

/* What lies at an address that the other side has from the linker. */
static void *at(uint32_t address)
{
    return (void *)(uintptr_t)address;
}

/* Takes what belongs to a command and carries it out. False: there is no such command, or the link was closed. */
static bool obeyed(uint8_t command)
{
    uint32_t place[2]; /* address and count */
    bool known = true;
    switch (command) {
    case SIZES:
        send_sizes();
        break;
    case START:
        known = board_receive(&u, sizeof u);
        if (known) {
            answer(start);
        }
        break;
    case UPDATE:
        known = board_receive(&u, sizeof u);
        if (known) {
            answer(sample);
        }
        break;
    case STATE:
        known = board_receive(x, sizeof *x);
        if (known) {
            answer(outputs);
        }
        break;
    case PARAMETERS:
        known = board_receive(&calibration, sizeof calibration);
        if (known) {
            answer(outputs);
        }
        break;
    case READ:
        known = board_receive(place, sizeof place);
        if (known) {
            board_send(at(place[0]), place[1]);
        }
        break;
    case WRITE:
        known = board_receive(place, sizeof place);
        if (known) {
            known = board_receive(at(place[0]), place[1]);
        }
        if (known) {
            answer(outputs);
        }
        break;
    default:
        known = false;
        break;
    }
    return known;
}

int main(void)
{
    uint8_t command = SIZES;
    bool known = true;
    calibration = controller_parameters;
    while (known && board_receive(&command, 1)) {
        known = obeyed(command);
    }
    return known ? 0 : 1;
}

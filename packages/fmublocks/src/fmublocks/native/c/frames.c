/* Steps of an FMU with a terminal: the frames that arrive in them are sent. */
#include "instance.h"

/* A step in which frames have arrived is made again sample by sample, so that none is missed. */
Status step_and_send(Instance *instance, double time, double step_size)
{
    if (!instance->has_events)
        return make_step(instance, time, step_size);
    Memory *memory = &instance->memory;
    take_over_written(instance);
    const Memory before = *memory;
    const double end = time + step_size;
    char text[NUMBER_LENGTH];
    Status status = make_step(instance, time, step_size);
    if (status != OK || memory->values.y.FRAME_COUNTER == before.terminal.sent)
        return status;
    *memory = before;
    while (status == OK && time < end) {
        const int last = end - time <= SAMPLE_TIME * (1.0 + TICK_TOLERANCE);
        status = make_step(instance, time, last ? end - time : SAMPLE_TIME);
        time = memory->time = last ? end : memory->time;
        if (status == OK && !send_frame(memory))
            status = discard(
                instance,
                "the step of %s s is refused; Tx_Data has no room for the frames that arrive in it; "
                "shorter steps are allowed",
                write_number(text, step_size));
    }
    if (status != OK)
        *memory = before;
    memory->last_step = status;
    return status;
}

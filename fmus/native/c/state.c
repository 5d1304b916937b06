/* Saved states: copies of the instance's memory, and their form as bytes. */
#include "state.h"

#include <string.h>

fmi2Status get_state(const Instance *instance, fmi2FMUstate *state)
{
    if (!*state)
        *state = instance->callbacks.allocateMemory(1, sizeof(Memory));
    if (!*state)
        return refuse(instance, "no memory for a state of the FMU");
    memcpy(*state, &instance->memory, sizeof(Memory));
    return fmi2OK;
}

/* CRC-32 of IEEE 802.3 over all but the checksum itself. */
static uint32_t checksum_of(const SavedState *saved)
{
    const unsigned char *byte = (const unsigned char *)saved->guid, *end = (const unsigned char *)(saved + 1);
    uint32_t sum = 0xFFFFFFFFU;
    for (; byte < end; byte++) {
        sum ^= *byte;
        for (int bit = 0; bit < 8; bit++)
            sum = (sum >> 1) ^ (0xEDB88320U & (0U - (sum & 1U)));
    }
    return ~sum;
}

fmi2Status serialize_state(const Instance *instance, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    SavedState saved;
    if (size < sizeof saved)
        return refuse(
            instance, "size = %lu is refused; a state takes %lu bytes", (unsigned long)size, (unsigned long)sizeof saved);
    memset(&saved, 0, sizeof saved);
    strncpy(saved.guid, model_guid, sizeof saved.guid - 1);
    memcpy(&saved.memory, state, sizeof saved.memory);
    saved.checksum = checksum_of(&saved);
    memcpy(bytes, &saved, sizeof saved);
    return fmi2OK;
}

fmi2Status deserialize_state(const Instance *instance, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
{
    SavedState saved;
    if (size != sizeof saved)
        return refuse(
            instance,
            "the FMU state is refused: it has %lu bytes, one of this FMU has %lu",
            (unsigned long)size,
            (unsigned long)sizeof saved);
    memcpy(&saved, bytes, sizeof saved);
    const int64_t mode = saved.memory.mode;
    const int known = mode == INSTANTIATED || mode == INITIALIZATION || mode == STEPPING || mode == TERMINATED;
    if (saved.checksum != checksum_of(&saved) || !known)
        return refuse(instance, "the FMU state is refused: its bytes are damaged");
    if (strncmp(saved.guid, model_guid, sizeof saved.guid) != 0)
        return refuse(instance, "the FMU state is refused: it was saved by another build than %s", model_guid);
    if (!*state)
        *state = instance->callbacks.allocateMemory(1, sizeof(Memory));
    if (!*state)
        return refuse(instance, "no memory for a state of the FMU");
    memcpy(*state, &saved.memory, sizeof saved.memory);
    return fmi2OK;
}

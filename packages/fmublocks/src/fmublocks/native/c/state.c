/* Saved states: copies of the instance's memory, and their form as bytes. */
#include "instance.h"

#include <stdio.h>
#include <string.h>

/* What goes before the memory in the bytes of a state: whether they are whole, and which build they are of. */
typedef struct {
    uint32_t checksum;
    char guid[44];
} Head;

/* Copies the memory into a state, which is made if there is none yet. */
static Status keep(const Instance *instance, const Memory *memory, void **state)
{
    if (!*state)
        *state = instance->host.allocate(1, sizeof *memory);
    if (!*state)
        return refuse(instance, "no memory for a state of the FMU");
    memcpy(*state, memory, sizeof *memory);
    return OK;
}

Status get_state(Instance *instance, void **state)
{
    take_over_written(instance);
    return keep(instance, &instance->memory, state);
}

Status set_state(Instance *instance, const void *state)
{
    const Status status = check_kind(instance, state);
    if (status == OK) {
        memcpy(&instance->memory, state, sizeof instance->memory);
        know_parameters(instance);
    }
    return status;
}

/* CRC-32 of IEEE 802.3 over all but the checksum itself. */
static uint32_t checksum_of(const void *bytes, size_t size)
{
    const unsigned char *byte = bytes, *end = byte + size;
    uint32_t sum = 0xFFFFFFFFU;
    for (byte += sizeof sum; byte < end; byte++) {
        sum ^= *byte;
        for (int bit = 0; bit < 8; bit++)
            sum = (sum >> 1) ^ (0xEDB88320U & (0U - (sum & 1U)));
    }
    return ~sum;
}

size_t serialized_size(void)
{
    return sizeof(Head) + sizeof(Memory);
}

Status serialize_state(const Instance *instance, const void *state, void *bytes, size_t size)
{
    const size_t needed = serialized_size();
    if (size < needed)
        return refuse(
            instance, "size = %lu is refused; a state takes %lu bytes", (unsigned long)size, (unsigned long)needed);
    Head head = {.guid = ""};
    snprintf(head.guid, sizeof head.guid, "%s", model_guid);
    memcpy(bytes, &head, sizeof head);
    memcpy((char *)bytes + sizeof head, state, sizeof(Memory));
    head.checksum = checksum_of(bytes, needed);
    memcpy(bytes, &head.checksum, sizeof head.checksum);
    return OK;
}

Status deserialize_state(const Instance *instance, const void *bytes, size_t size, void **state)
{
    Head head;
    Memory memory;
    if (size < sizeof head)
        return refuse(instance, DAMAGED_STATE);
    memcpy(&head, bytes, sizeof head);
    head.guid[sizeof head.guid - 1] = '\0';
    if (head.checksum != checksum_of(bytes, size))
        return refuse(instance, DAMAGED_STATE);
    if (strcmp(head.guid, model_guid) != 0)
        return refuse(instance, FOREIGN_STATE(head.guid, model_guid));
    if (size != serialized_size())
        return refuse(instance, DAMAGED_STATE);
    memcpy(&memory, (const char *)bytes + sizeof head, sizeof memory);
    return check_content(instance, &memory) == OK ? keep(instance, &memory, state) : ERROR;
}

/* See carrystep_look.h. */
#include "carrystep_look.h"

/* Registers of an axis in a snapshot, and in the record of a latch. */
static const uint8_t OF_SNAPSHOT[] = {CARRYSTEP_SNAPSHOT_P_HIGH, CARRYSTEP_SNAPSHOT_POSITION, CARRYSTEP_SNAPSHOT_STATUS,
                                      CARRYSTEP_SNAPSHOT_LEFT};
static const uint8_t OF_RECORD[] = {CARRYSTEP_LATCH_P_HIGH, CARRYSTEP_LATCH_POSITION, CARRYSTEP_LATCH_STATUS};

/* Registers that are read once with a snapshot: two of them always, the others for latches. */
static const uint8_t ALONE[] = {CARRYSTEP_SNAPSHOT_TICKS, CARRYSTEP_INPUTS, CARRYSTEP_INPUT_LEVELS, CARRYSTEP_CAPTURES,
                                CARRYSTEP_LATCHES};

static uint32_t alone(const carrystep_look *look)
{
    return look->latched ? (uint32_t)sizeof ALONE : 2u;
}

static bool records(const carrystep_look *look)
{
    return look->stage == CARRYSTEP_LOOK_RECORDING;
}

static uint32_t registers(const carrystep_look *look)
{
    return records(look) ? 3u * look->axes : alone(look) + 4u * look->axes;
}

/* The register with this number in the set of those that are read. */
static uint8_t register_of(const carrystep_look *look, uint32_t number)
{
    if (records(look)) {
        return (uint8_t)CARRYSTEP_OF_AXIS(OF_RECORD[number % 3u], number / 3u);
    }
    if (number < alone(look)) {
        return ALONE[number];
    }
    number -= alone(look);
    return (uint8_t)CARRYSTEP_OF_AXIS(OF_SNAPSHOT[number % 4u], number / 4u);
}

static void set(carrystep_look *look, uint32_t number, uint32_t data)
{
    uint32_t *once[] = {&look->ticks, &look->inputs, &look->levels, &look->captures, &look->latches};
    uint32_t each = records(look) ? 3u : 4u;
    if (!records(look) && number < alone(look)) {
        *once[number] = data;
        return;
    }
    number -= records(look) ? 0u : alone(look);
    carrystep_seen *seen = records(look) ? &look->record[number / each] : &look->seen[number / each];
    uint32_t *words[] = {&seen->p_high, &seen->position, &seen->status, &seen->left};
    *words[number % each] = data;
}

/* Whether a write of this register is acknowledged. Any answer may do that, if its own was lost. */
static bool is_taken(const carrystep_session *session, uint8_t address)
{
    for (unsigned index = 0; index < session->length; index++) {
        unsigned slot = (session->at + index) % CARRYSTEP_SLOTS;
        if (session->slots[slot].address == (CARRYSTEP_WRITE | address)) {
            return false;
        }
    }
    return true;
}

static void begin_reading(carrystep_look *look, carrystep_look_stage stage)
{
    look->stage = stage;
    look->missing = ((uint64_t)1 << registers(look)) - 1u;
}

bool carrystep_look_begin(carrystep_look *look, carrystep_session *session, uint64_t now, uint32_t count)
{
    if (look->stage != CARRYSTEP_LOOK_NONE || !carrystep_write(session, CARRYSTEP_SNAPSHOT, 1)) {
        return false;
    }
    look->stage = CARRYSTEP_LOOK_WRITTEN;
    look->count = count;
    look->before = now;
    look->begun = now;
    return true;
}

void carrystep_look_read(carrystep_look *look, carrystep_session *session)
{
    if (look->stage == CARRYSTEP_LOOK_CHOSEN && is_taken(session, CARRYSTEP_LATCH)) {
        begin_reading(look, CARRYSTEP_LOOK_RECORDING);
    }
    if (look->stage != CARRYSTEP_LOOK_READING && look->stage != CARRYSTEP_LOOK_RECORDING) {
        return;
    }
    /* In this order: an input that is active was so before the state of the latches is read. */
    for (uint32_t number = 0; number < registers(look); number++) {
        if ((look->missing >> number & 1u) != 0 && !carrystep_read(session, register_of(look, number))) {
            return;
        }
    }
}

carrystep_look_event carrystep_look_take(carrystep_look *look, carrystep_session *session, uint64_t now,
                                         const carrystep_answer *answer)
{
    if (look->stage == CARRYSTEP_LOOK_WRITTEN && is_taken(session, CARRYSTEP_SNAPSHOT)) {
        look->after = now;
        begin_reading(look, CARRYSTEP_LOOK_READING);
    }
    if ((look->stage != CARRYSTEP_LOOK_READING && look->stage != CARRYSTEP_LOOK_RECORDING) || answer->written) {
        return CARRYSTEP_LOOK_NOTHING;
    }
    for (uint32_t number = 0; number < registers(look); number++) {
        if ((look->missing >> number & 1u) == 0 || register_of(look, number) != answer->address) {
            continue;
        }
        look->missing &= ~((uint64_t)1 << number);
        set(look, number, answer->data);
        if (look->missing == 0) {
            carrystep_look_event whole = records(look) ? CARRYSTEP_LOOK_RECORD : CARRYSTEP_LOOK_SNAPSHOT;
            look->stage = CARRYSTEP_LOOK_NONE;
            return whole;
        }
        break;
    }
    return CARRYSTEP_LOOK_NOTHING;
}

/* Whether the build has several latches: then a word of LATCH arms some and chooses one. */
static bool several(const carrystep_look *look)
{
    return look->latches != 0;
}

bool carrystep_look_record(carrystep_look *look, carrystep_session *session, uint8_t latch)
{
    if (look->stage != CARRYSTEP_LOOK_NONE) {
        return false;
    }
    /* The only latch of a build has the only record, and any word would arm it. */
    if (several(look) && !carrystep_write(session, CARRYSTEP_LATCH, CARRYSTEP_LATCH_WORD(0, latch))) {
        return false;
    }
    look->latch = latch;
    look->stage = CARRYSTEP_LOOK_CHOSEN;
    return true;
}

bool carrystep_look_armed(const carrystep_look *look, uint8_t latch)
{
    return several(look) ? (look->latches >> (latch & 3u) & 1u) != 0 : (look->captures >> 12 & 1u) != 0;
}

bool carrystep_look_arm(const carrystep_look *look, carrystep_session *session, uint8_t latch)
{
    /* The gateware takes a latch that it has not for a fault. */
    if (several(look) ? (look->latches >> (4u + (latch & 3u)) & 1u) == 0 : latch != 0) {
        return false;
    }
    uint32_t word = several(look) ? CARRYSTEP_LATCH_WORD(1u << (latch & 3u), latch) : 1u;
    return carrystep_write(session, CARRYSTEP_LATCH, word);
}

/* See carrystep_feedback.h. */
#include "carrystep_feedback.h"

#include <string.h>

#define A_STEP ((carrystep_place)1 << 64)
#define HALF_A_STEP ((carrystep_place)1 << 63)

void carrystep_remember(carrystep_sent *sent, const carrystep_block *block)
{
    sent->blocks[sent->sent % CARRYSTEP_REMEMBERED] = *block;
    sent->sent++;
}

carrystep_place carrystep_actual(const carrystep_seen *seen)
{
    int32_t way = (int32_t)(seen->status >> 12 & 15u);
    int64_t pulses = seen->position < UINT32_C(0x80000000) ? (int64_t)seen->position
                                                           : (int64_t)seen->position - INT64_C(0x100000000);
    int64_t steps = pulses + (way < 8 ? way : way - 16);
    carrystep_place part = (carrystep_place)((uint64_t)seen->p_high << 32);
    return (carrystep_place)steps * ((carrystep_place)1 << 64) + part - HALF_A_STEP;
}

bool carrystep_commanded(const carrystep_sent *sent, uint32_t count, uint32_t slots, uint8_t axis,
                         const carrystep_seen *seen, carrystep_place *place, uint64_t *ticks)
{
    const carrystep_block *block;
    uint32_t slot = seen->status & CARRYSTEP_STATUS_SLOT;
    uint32_t back, done;
    if ((seen->status & CARRYSTEP_STATUS_RUNS) == 0 || slots == 0 || slots > CARRYSTEP_REMEMBERED / 2u ||
        slot >= slots || count == 0 || count > sent->sent || sent->sent - count > CARRYSTEP_REMEMBERED / 2u) {
        return false;
    }
    /* The running block is one of the last `slots` ones. The first one after a clear runs in slot 1. */
    back = (count + slots - slot) % slots;
    if (back >= count) {
        return false;
    }
    block = &sent->blocks[(count - 1u - back) % CARRYSTEP_REMEMBERED];
    if (seen->left >= block->axes[axis].ticks) {
        return false;
    }
    done = block->axes[axis].ticks - 1u - seen->left;
    *place = block->at[axis] + carrystep_distance(&block->axes[axis], done);
    *ticks = block->before + done;
    return true;
}

bool carrystep_measure(const carrystep_sent *sent, uint32_t count, uint32_t slots, uint8_t axes,
                       const carrystep_seen *seen, carrystep_places *places)
{
    bool all = count > 0;
    memset(places, 0, sizeof *places);
    for (uint8_t axis = 0; axis < axes; axis++) {
        carrystep_place planned, error;
        places->at[axis] = carrystep_actual(&seen[axis]);
        if (count == 0 ||
            !carrystep_commanded(sent, count, slots, axis, &seen[axis], &planned, &places->gone_by)) {
            all = false;
            continue;
        }
        error = places->at[axis] - planned;
        places->error[axis] = carrystep_steps_of(error);
        if (error >= A_STEP || error <= -A_STEP) {
            places->lost |= (uint8_t)(1u << axis);
        }
    }
    if (all) {
        const carrystep_block *last = &sent->blocks[(count - 1u) % CARRYSTEP_REMEMBERED];
        places->reserve = last->before + last->axes[0].ticks - places->gone_by;
    }
    return all;
}

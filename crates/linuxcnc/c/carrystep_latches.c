/* See carrystep_latches.h. */
#include "carrystep_latches.h"

/* Snapshots that must agree before a contradiction counts. */
#define DOUBTS 2u

void carrystep_latches_begin(carrystep_latches *latches, uint8_t probe, uint8_t index)
{
    latches->probe.number = probe;
    latches->probe.state = CARRYSTEP_LATCH_IDLE;
    latches->probe.doubts = 0;
    latches->index.number = index;
    latches->index.state = CARRYSTEP_LATCH_IDLE;
    latches->index.doubts = 0;
    latches->closed = false;
}

static void arm(carrystep_latch *latch, carrystep_look *look, carrystep_session *session)
{
    latch->state = carrystep_look_arm(look, session, latch->number) ? CARRYSTEP_LATCH_ARMED : CARRYSTEP_LATCH_IDLE;
    latch->doubts = 0;
}

static void find(carrystep_latch *latch, carrystep_look *look, carrystep_session *session)
{
    if (carrystep_look_record(look, session, latch->number)) {
        latch->state = CARRYSTEP_LATCH_FOUND;
        latch->doubts = 0;
    }
}

static void take_probe(carrystep_latches *latches, carrystep_look *look, carrystep_session *session)
{
    carrystep_latch *latch = &latches->probe;
    bool closed = (look->inputs >> CARRYSTEP_PROBE_BIT & 1u) != 0;
    if (latch->number == CARRYSTEP_NO_LATCH) {
        latches->closed = closed;
        return;
    }
    if (latch->state == CARRYSTEP_LATCH_ARMED) {
        bool edge = !carrystep_look_armed(look, latch->number);
        if (closed && edge) {
            find(latch, look, session);
            return;
        }
        bool waits = edge && (look->levels >> CARRYSTEP_PROBE_BIT & 1u) != 0;
        latch->doubts = closed != edge && !waits ? (uint8_t)(latch->doubts + 1u) : 0u;
        if (latch->doubts < DOUBTS) {
            return;
        }
    }
    if (closed) {
        /* Without a record of its edge: the place is that of the snapshot. */
        latch->state = CARRYSTEP_LATCH_DONE;
        latches->closed = true;
    } else {
        latches->closed = false;
        arm(latch, look, session);
    }
}

static void take_index(carrystep_latch *latch, carrystep_look *look, carrystep_session *session, bool wanted)
{
    if (latch->number == CARRYSTEP_NO_LATCH) {
        return;
    }
    if (!wanted) {
        latch->state = CARRYSTEP_LATCH_IDLE;
    } else if (look->stage != CARRYSTEP_LOOK_NONE) {
        return; /* the probe's record is read: no other latch may be chosen */
    } else if (latch->state == CARRYSTEP_LATCH_IDLE) {
        arm(latch, look, session);
    } else if (latch->state == CARRYSTEP_LATCH_ARMED && !carrystep_look_armed(look, latch->number)) {
        find(latch, look, session);
    }
}

void carrystep_latches_take(carrystep_latches *latches, carrystep_look *look, carrystep_session *session, bool wanted)
{
    take_probe(latches, look, session);
    take_index(&latches->index, look, session, wanted);
}

carrystep_record carrystep_latches_record(carrystep_latches *latches)
{
    if (latches->probe.state == CARRYSTEP_LATCH_FOUND) {
        latches->probe.state = CARRYSTEP_LATCH_DONE;
        latches->closed = true;
        return CARRYSTEP_RECORD_PROBE;
    }
    if (latches->index.state == CARRYSTEP_LATCH_FOUND) {
        latches->index.state = CARRYSTEP_LATCH_DONE;
        return CARRYSTEP_RECORD_INDEX;
    }
    return CARRYSTEP_RECORD_NONE;
}

uint32_t carrystep_latches_inputs(const carrystep_latches *latches, const carrystep_look *look)
{
    uint32_t probe = UINT32_C(1) << CARRYSTEP_PROBE_BIT;
    return (look->inputs & ~probe) | (latches->closed ? probe : 0u);
}

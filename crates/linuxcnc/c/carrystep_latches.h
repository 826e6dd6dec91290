/* When a latch of the board is armed, and which of its records counts: for the probe, and for index
 * pulses. A latch keeps the place of the first edge since it was armed.
 *
 * The latch of the probe is armed while the probe is open. The component shows the probe as closed
 * when it has read the record of the edge that closed it. Two successive snapshots, one about
 * every 10 ms, decide the other cases:
 *
 *     latch has an edge, pin inactive    noise: the latch is armed again
 *     latch has no edge, probe closed    it was closed before the latch was armed: shown as closed
 *     pin active, level not accepted     the debounce time is not over: wait */
#ifndef CARRYSTEP_LATCHES_H
#define CARRYSTEP_LATCHES_H

#include "carrystep_look.h"

/* Bit of INPUTS: the probe. */
#define CARRYSTEP_PROBE_BIT 16u

typedef enum {
    CARRYSTEP_LATCH_IDLE,
    CARRYSTEP_LATCH_ARMED,
    CARRYSTEP_LATCH_FOUND, /* its record is read */
    CARRYSTEP_LATCH_DONE   /* until the probe opens, or no index is wanted */
} carrystep_latch_state;

typedef struct {
    uint8_t number; /* of the latch, or CARRYSTEP_NO_LATCH */
    carrystep_latch_state state;
    uint8_t doubts; /* snapshots in a row that contradict each other */
} carrystep_latch;

typedef struct {
    carrystep_latch probe;
    carrystep_latch index;
    bool closed; /* the probe, as it is shown */
} carrystep_latches;

/* No latch is armed, whatever an earlier host did. */
void carrystep_latches_begin(carrystep_latches *latches, uint8_t probe, uint8_t index);

/* Takes a snapshot. `wanted`: an index pulse is waited for. Arms latches, and begins to read the
 * record of one that has found its edge. */
void carrystep_latches_take(carrystep_latches *latches, carrystep_look *look, carrystep_session *session, bool wanted);

/* The inputs of the last snapshot, with the probe as it is shown. */
uint32_t carrystep_latches_inputs(const carrystep_latches *latches, const carrystep_look *look);

/* Takes the record. What it belongs to. */
typedef enum { CARRYSTEP_RECORD_NONE, CARRYSTEP_RECORD_PROBE, CARRYSTEP_RECORD_INDEX } carrystep_record;
carrystep_record carrystep_latches_record(carrystep_latches *latches);

#endif

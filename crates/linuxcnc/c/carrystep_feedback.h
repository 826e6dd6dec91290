/* Where the axes are, and where they were commanded to be at the same moment, from a snapshot.
 *
 * A snapshot names the slot of the running segment and the ticks that are left of it. With the
 * blocks that were sent this gives the exact place that the axis was commanded to have in that
 * tick. What the engine reports as its own place differs from it only if something was lost. So
 *
 *     position-fb = cmd(t) - (cmd(t_latch) - position_latch)
 *
 * has no part of the queue's delay. Nothing here calls the operating system. */
#ifndef CARRYSTEP_FEEDBACK_H
#define CARRYSTEP_FEEDBACK_H

#include "carrystep_blocks.h"

/* Number of blocks that are remembered: more than the engine has slots (32). */
#define CARRYSTEP_REMEMBERED 64u

/* The blocks of a stream that were sent; all bytes 0 at the beginning. */
typedef struct {
    carrystep_block blocks[CARRYSTEP_REMEMBERED];
    uint32_t sent;
} carrystep_sent;

/* What a snapshot says of an axis. */
typedef struct {
    uint32_t p_high;   /* SNAPSHOT_P_HIGH */
    uint32_t position; /* SNAPSHOT_POSITION */
    uint32_t status;   /* SNAPSHOT_STATUS */
    uint32_t left;     /* SNAPSHOT_LEFT */
} carrystep_seen;

/* Adds a block that was just sent. */
void carrystep_remember(carrystep_sent *sent, const carrystep_block *block);

/* The place of an axis by its own registers: the commanded steps and P, of which only the high half
 * is used (2^-32 step). A position of 0 with P in the middle of a step is place 0. */
carrystep_place carrystep_actual(const carrystep_seen *seen);

/* The place that axis `axis` was commanded to have in the snapshot, and how many ticks of the stream
 * had gone by. `count` blocks had been sent before the snapshot; `slots` is QUEUE_DEPTH + 1. False
 * if the axis did not run, or if the snapshot fits no block. */
bool carrystep_commanded(const carrystep_sent *sent, uint32_t count, uint32_t slots, uint8_t axis,
                         const carrystep_seen *seen, carrystep_place *place, uint64_t *ticks);

/* What a snapshot shows of all axes. */
typedef struct {
    carrystep_place at[CARRYSTEP_MOST_AXES];
    double error[CARRYSTEP_MOST_AXES]; /* steps: place less command; 0 where the command is not known */
    uint8_t lost;     /* the axes that are off by a step or more, one bit each */
    uint64_t gone_by; /* ticks of the stream */
    uint64_t reserve; /* ticks until the end of the last block that was sent */
} carrystep_places;

/* Compares the axes with the first `count` blocks; 0: no stream runs. False if not all of them run
 * a block: the start has not been executed yet, or the axes have stopped. */
bool carrystep_measure(const carrystep_sent *sent, uint32_t count, uint32_t slots, uint8_t axes,
                       const carrystep_seen *seen, carrystep_places *places);

#endif

/* How much longer segments are than the servo periods that they stand for, so that a queue neither
 * runs dry nor full although the clocks of computer and board differ.
 *
 * The lead is the time from the tick that the engine executes to the end of the last block that the
 * servo thread has made. The trim is the difference of the clocks (carrystep_time.h) and a part that
 * returns the lead slowly to the horizon. Integers only. */
#ifndef CARRYSTEP_TRIM_H
#define CARRYSTEP_TRIM_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    int64_t horizon; /* wanted lead, ticks */
    int64_t mean;    /* mean lead in 1/64 tick */
    bool known;
} carrystep_trim;

/* Greatest trim, parts per 10^9: a speed that is wrong by a five hundredth at most. */
#define CARRYSTEP_MOST_TRIM 2000000

void carrystep_trim_begin(carrystep_trim *trim, int64_t horizon);

/* Takes a lead, in ticks, about every 10 ms, and the difference of the clocks in parts per 10^9 (0
 * while it is not known). Returns the trim in parts per 10^9. */
int32_t carrystep_trim_take(carrystep_trim *trim, int64_t lead, int64_t faster);

#endif

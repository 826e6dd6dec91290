/* The gateware's time as its host sees it: the count of ticks without its wraps, and the difference
 * between the gateware's clock and the host's.
 *
 * C99, without allocation and floating point. */
#ifndef CARRYSTEP_TIME_H
#define CARRYSTEP_TIME_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Number of observations that are kept to compare later ones with. */
#define CARRYSTEP_MARKS 16

/* The count of ticks; all bytes 0 at the beginning. */
typedef struct {
    int64_t latest;
    bool known;
} carrystep_ticks;

/* The number of the tick with this value of TICKS, which wraps every 2^32 ticks. A value belongs to
 * a tick less than 2^31 ticks (1.2 hours at 2 us) from the latest one seen before, so a host must
 * see one at least that often. The first value counts as itself. */
int64_t carrystep_tick(carrystep_ticks *ticks, uint32_t value);

/* An observation: the tick was read between these two times of the host, in us. */
typedef struct {
    int64_t tick;
    uint64_t before;
    uint64_t after;
} carrystep_mark;

/* A comparison of the gateware's clock with the host's; initialised by carrystep_compare.
 *
 * Of two observations the ticks between them are known within 2 ticks on either side, and the
 * host's time between them within the lengths of both reads. Each pair of observations bounds the
 * ratio of the clocks, and the result is what all these bounds allow. */
typedef struct {
    carrystep_mark marks[CARRYSTEP_MARKS];
    int64_t least, greatest; /* parts per 10^9 */
    uint32_t tick_ns;
    uint8_t count; /* marks in use */
    bool known;    /* least and greatest have a value */
} carrystep_clocks;

/* Begins a comparison with a gateware whose ticks have this length, more than 0 (register
 * TICK_NS). */
void carrystep_compare(carrystep_clocks *clocks, uint32_t tick_ns);

/* Adds an observation: the tick with this number was read at a time of the host between `before`
 * and `after`, in us. If it contradicts the ones before, a rate has changed, and the comparison
 * begins again. */
void carrystep_observe(carrystep_clocks *clocks, int64_t tick, uint64_t before, uint64_t after);

/* By how much the gateware's clock is faster than the host's, and the greatest error of that, in
 * parts per 10^9. False before two observations. */
bool carrystep_clock_difference(const carrystep_clocks *clocks, int64_t *faster, int64_t *bound);

#ifdef __cplusplus
}
#endif

#endif

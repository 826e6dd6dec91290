/* See carrystep_time.h. */
#include "carrystep_time.h"

#include <string.h>

#define HALF INT64_C(0x80000000)

/* Uncertainty of a count that was read, in ticks: the tick that runs, and the one before it while
 * its words are being written. */
#define UNCERTAIN 2

/* The greatest difference, in ns, that is computed: beyond it a ratio counts as without a bound. */
#define MOST_NS (INT64_MAX / INT64_C(1000000))

int64_t carrystep_tick(carrystep_ticks *ticks, uint32_t value)
{
    int64_t tick = (int64_t)value;
    if (ticks->known) {
        int64_t ahead = (int64_t)(uint32_t)(value - (uint32_t)ticks->latest);
        tick = ticks->latest + (ahead < HALF ? ahead : ahead - 2 * HALF);
    }
    if (!ticks->known || tick > ticks->latest) {
        ticks->latest = tick;
    }
    ticks->known = true;
    return tick;
}

void carrystep_compare(carrystep_clocks *clocks, uint32_t tick_ns)
{
    memset(clocks, 0, sizeof *clocks);
    clocks->tick_ns = tick_ns;
}

/* By how much `ticks` ticks are longer than `us`, in parts per 10^9, rounded down. */
static int64_t excess(int64_t ticks, uint32_t tick_ns, int64_t us)
{
    int64_t most = INT64_MAX / (int64_t)tick_ns;
    if (ticks > most || ticks < -most || us > INT64_MAX / 1000) {
        return ticks < 0 ? INT64_MIN : INT64_MAX;
    }
    int64_t own = ticks * (int64_t)tick_ns, of_host = us * 1000;
    int64_t ns = own < of_host - INT64_MAX ? -INT64_MAX : own - of_host;
    if (ns > MOST_NS || ns < -MOST_NS) {
        return ns < 0 ? INT64_MIN : INT64_MAX;
    }
    int64_t parts = ns * INT64_C(1000000);
    return parts / us - (parts % us < 0);
}

/* The bounds of the ratio that two observations give; false if they overlap. */
static bool bounds(const carrystep_clocks *clocks, const carrystep_mark *earlier,
                   const carrystep_mark *later, int64_t *least, int64_t *greatest)
{
    if (later->before <= earlier->after || later->after - earlier->before > INT64_MAX) {
        return false;
    }
    int64_t ticks = later->tick - earlier->tick;
    int64_t longest = (int64_t)(later->after - earlier->before);
    int64_t shortest = (int64_t)(later->before - earlier->after);
    *least = excess(ticks - UNCERTAIN, clocks->tick_ns, longest);
    *greatest = excess(ticks + UNCERTAIN, clocks->tick_ns, shortest);
    *greatest += *greatest < INT64_MAX; /* it was rounded down */
    return true;
}

void carrystep_observe(carrystep_clocks *clocks, int64_t tick, uint64_t before, uint64_t after)
{
    carrystep_mark mark = {tick, before, after};
    bool narrower = true;
    for (uint8_t at = 0; at < clocks->count; at++) {
        int64_t least, greatest;
        if (!bounds(clocks, &clocks->marks[at], &mark, &least, &greatest)) {
            continue;
        }
        if (!clocks->known || least > clocks->least) {
            clocks->least = least;
        }
        if (!clocks->known || greatest < clocks->greatest) {
            clocks->greatest = greatest;
        }
        clocks->known = true;
    }
    if (clocks->known && clocks->least > clocks->greatest) {
        clocks->known = false;
        clocks->count = 0;
    }
    for (uint8_t at = 0; at < clocks->count; at++) {
        uint64_t width = clocks->marks[at].after - clocks->marks[at].before;
        narrower = narrower && after - before < width / 2;
    }
    if (narrower && clocks->count < CARRYSTEP_MARKS) {
        clocks->marks[clocks->count++] = mark;
    }
}

bool carrystep_clock_difference(const carrystep_clocks *clocks, int64_t *faster, int64_t *bound)
{
    if (!clocks->known) {
        return false;
    }
    /* The sum of both, halved without an overflow. */
    int64_t low = clocks->least / 2, high = clocks->greatest / 2;
    *faster = low + high + (clocks->least % 2 + clocks->greatest % 2) / 2;
    *bound = high - low + 1;
    return true;
}

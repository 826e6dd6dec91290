/* Reads a tick length, then observations, one a line: the value of TICKS, and the host's times
 * before and after. Answers each with the number of the tick and the difference of the clocks. */
#include "carrystep_time.h"

#include <inttypes.h>
#include <stdio.h>

int main(void)
{
    carrystep_ticks ticks = {0, false};
    carrystep_clocks clocks;
    uint32_t tick_ns, value;
    uint64_t before, after;
    if (scanf("%" SCNu32, &tick_ns) != 1) {
        return 1;
    }
    carrystep_compare(&clocks, tick_ns);
    while (scanf("%" SCNu32 " %" SCNu64 " %" SCNu64, &value, &before, &after) == 3) {
        int64_t faster = 0, bound = 0;
        int64_t tick = carrystep_tick(&ticks, value);
        carrystep_observe(&clocks, tick, before, after);
        bool known = carrystep_clock_difference(&clocks, &faster, &bound);
        printf("%" PRId64 " %d %" PRId64 " %" PRId64 "\n", tick, known, faster, bound);
    }
    return 0;
}

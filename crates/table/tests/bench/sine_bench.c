/* sine_bench STEPS COUNTS prints the delays of a ramp of STEPS steps in COUNTS timer counts,
 * computed from the small inverse table for CTC, or "refused". */
#include <stdio.h>
#include <stdlib.h>

#include "carrystep_sine.h"
#include "ramp.h"

static uint16_t delays[65535];

int main(int argc, char **argv)
{
    uint16_t steps = argc > 1 ? (uint16_t)strtoul(argv[1], NULL, 10) : 0;
    uint32_t counts = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 0;
    uint16_t intervals = sizeof ramp_inverse / sizeof ramp_inverse[0] - 1;
    if (!carrystep_sine_ramp(ramp_inverse, intervals, steps, counts, RAMP_CTC, delays)) {
        puts("refused");
        return 0;
    }
    for (uint16_t step = 0; step < steps; step++) {
        printf("%u\n", (unsigned)delays[step]);
    }
    return ramp_table.cruise == RAMP_CRUISE ? 0 : 1;
}

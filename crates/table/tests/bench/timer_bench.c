/* Plays moves on a simulated compare timer, which counts one clock at a time.
 *
 * timer_bench LATENCY MOVE...   Each MOVE is STEPS or STEPS:STOP; the bench stops the latter at
 * pulse STOP. For each move it prints the clock of every pulse and then "end". The interrupt
 * handler runs LATENCY counts after its match. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "ramp.h"

#define MASK ((UINT32_C(1) << RAMP_TIMER_BITS) - 1)

static carrystep_player player;

static uint32_t next_match(uint32_t before, uint16_t compare)
{
    return RAMP_CTC ? compare : (before + compare) & MASK;
}

static void play(uint32_t latency, uint32_t steps, uint32_t stop)
{
    uint32_t counter = RAMP_CTC ? 0 : UINT32_C(0xFFF3) & MASK;
    uint32_t handler = 0; /* counts until the handler runs; 0: none is pending */
    uint32_t pulses = 0;
    uint16_t compare;
    uint32_t match;
    if (!carrystep_start(&player, &ramp_table, steps, &compare)) {
        return;
    }
    match = next_match(counter, compare);
    for (uint64_t clock = 1; pulses < steps + 1000; clock++) {
        bool hit;
        if (RAMP_CTC) {
            hit = counter == match;
            counter = hit ? 0 : (counter + 1) & MASK;
        } else {
            counter = (counter + 1) & MASK;
            hit = counter == match;
        }
        if (hit) {
            printf("%" PRIu64 "\n", clock);
            pulses++;
            handler = latency + 1;
        }
        if (handler > 0) {
            handler--;
            if (handler == 0) {
                if (pulses == stop) {
                    carrystep_stop(&player);
                }
                if (!carrystep_next(&player, &compare)) {
                    break;
                }
                match = next_match(match, compare);
            }
        }
    }
    /* A stray interrupt after the end must not move the motor. */
    if (carrystep_left(&player) != 0 || carrystep_next(&player, &compare) || carrystep_next(&player, &compare)) {
        puts("stray");
    }
}

int main(int argc, char **argv)
{
    uint32_t latency = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 0;
    for (int i = 2; i < argc; i++) {
        char *rest;
        uint32_t steps = (uint32_t)strtoul(argv[i], &rest, 10);
        uint32_t stop = *rest == ':' ? (uint32_t)strtoul(rest + 1, NULL, 10) : UINT32_MAX;
        play(latency, steps, stop);
        puts("end");
    }
    return 0;
}

/* Makes a sine ramp (acceleration 1 - cos) of any length and time on the controller, from one small table:
 * u = t / T against the fourth root of the distance done. Before a move, not in an interrupt: two
 * integer roots and a division a step. */
#ifndef CARRYSTEP_SINE_H
#define CARRYSTEP_SINE_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Fills `delays[steps]` with the delays of a ramp from rest, in timer counts (free-running compare
 * values; one less, `ctc` true, for CTC).
 *
 * inverse    the generated `NAME_inverse`, its intervals + 1 words
 * intervals  2 to 4096
 * steps      1 or more
 * counts     timer counts of the whole ramp, under 2^31: twice `steps` times the counts of a cruising step
 *
 * False, and the buffer is of no use: a delay is not 1 to 65535 counts, or a parameter is out of range. */
bool carrystep_sine_ramp(const uint16_t *inverse, uint16_t intervals, uint16_t steps, uint32_t counts, bool ctc,
                         uint16_t *delays);

#ifdef __cplusplus
}
#endif

#endif

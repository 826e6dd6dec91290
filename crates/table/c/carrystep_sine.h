/* Computes a sine ramp (acceleration 1 - cos) of any length and duration on the controller, from
 * one small table of u = t / T against the fourth root of the travelled fraction of the distance.
 * Each step takes two integer roots and a division: call it before a move, not in an interrupt. */
#ifndef CARRYSTEP_SINE_H
#define CARRYSTEP_SINE_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Fills `delays[steps]` with the compare values of a ramp from rest: the delays in timer counts for
 * a free-running timer (`ctc` false), or one less for CTC (`ctc` true).
 *
 * inverse    the generated array `NAME_inverse`, which has `intervals` + 1 words
 * intervals  2 to 4096
 * steps      1 or more
 * counts     timer counts of the whole ramp, below 2^31: 2 x `steps` x the counts of a cruise step
 *
 * Returns false if a delay is not 1 to 65535 counts or a parameter is out of range; the contents of
 * `delays` are then undefined. */
bool carrystep_sine_ramp(const uint16_t *inverse, uint16_t intervals, uint16_t steps, uint32_t counts, bool ctc,
                         uint16_t *delays);

#ifdef __cplusplus
}
#endif

#endif

/* Implementation of carrystep_sine.h, in fixed point; the comments give the scale of each value. */
#include "carrystep_sine.h"

#ifdef CARRYSTEP_PROGMEM
#include <avr/pgmspace.h>
#define READ(word) pgm_read_word(&(word))
#else
#define READ(word) (word)
#endif

/* Returns the integer square root, rounded down. It is computed bit by bit. */
static uint32_t root(uint64_t square)
{
    uint64_t rest = square;
    uint64_t result = 0;
    for (uint64_t bit = UINT64_C(1) << 62; bit != 0; bit >>= 2) {
        if (rest >= result + bit) {
            rest -= result + bit;
            result = (result >> 1) + bit;
        } else {
            result >>= 1;
        }
    }
    return (uint32_t)result;
}

/* Returns the counts from the start of the ramp to step `step` of `steps`, for step < steps. */
static uint32_t crossing(const uint16_t *inverse, uint16_t intervals, uint16_t step, uint16_t steps, uint32_t counts)
{
    uint32_t share = (uint32_t)(((uint64_t)step << 32) / steps); /* s x 2^32 */
    uint32_t half = root((uint64_t)share << 32);                 /* s^(1/2) x 2^32 */
    uint32_t fourth = root((uint64_t)half << 32);                /* s^(1/4) x 2^32 */
    uint64_t place = (uint64_t)fourth * intervals;               /* intervals x 2^32 */
    uint16_t left = (uint16_t)(place >> 32);
    uint16_t low = READ(inverse[left]);
    uint16_t high = READ(inverse[left + 1]);
    uint64_t part = ((place & UINT32_MAX) * (uint16_t)(high - low)) >> 16; /* x 2^16 */
    uint64_t u = ((uint64_t)low << 16) + part;                             /* u x 65535 x 2^16 */
    uint64_t scale = UINT64_C(65535) << 16;
    return (uint32_t)((u * counts + scale / 2) / scale);
}

bool carrystep_sine_ramp(const uint16_t *inverse, uint16_t intervals, uint16_t steps, uint32_t counts, bool ctc,
                         uint16_t *delays)
{
    uint32_t before = 0;
    if (intervals < 2 || intervals > 4096 || steps == 0 || counts >= UINT32_C(1) << 31) {
        return false;
    }
    for (uint16_t step = 0; step < steps; step++) {
        uint16_t next = (uint16_t)(step + 1);
        uint32_t after = next == steps ? counts : crossing(inverse, intervals, next, steps, counts);
        uint32_t delay = after - before;
        if (after <= before || delay > UINT16_MAX) {
            return false;
        }
        delays[step] = (uint16_t)(ctc ? delay - 1 : delay);
        before = after;
    }
    return true;
}

/* See carrystep_trim.h. */
#include "carrystep_trim.h"

/* The mean is over about so many leads. */
#define LEADS 64

/* Trim for a lead that is off by the whole horizon, parts per 10^9. */
#define GAIN INT64_C(4000000)

void carrystep_trim_begin(carrystep_trim *trim, int64_t horizon)
{
    trim->horizon = horizon > 0 ? horizon : 1;
    trim->mean = 0;
    trim->known = false;
}

static int64_t within(int64_t value, int64_t most)
{
    return value > most ? most : value < -most ? -most : value;
}

int32_t carrystep_trim_take(carrystep_trim *trim, int64_t lead, int64_t faster)
{
    /* A lead beyond ten horizons is not a lead; the bound also keeps the products small. */
    int64_t bounded = within(lead, 10 * trim->horizon);
    if (!trim->known) {
        trim->mean = trim->horizon * LEADS;
        trim->known = true;
    }
    trim->mean += bounded - trim->mean / LEADS;
    int64_t off = trim->mean / LEADS - trim->horizon;
    int64_t back = off * (GAIN / 1000) / trim->horizon * 1000;
    return (int32_t)within(within(faster, CARRYSTEP_MOST_TRIM) - back, CARRYSTEP_MOST_TRIM);
}

/* See carrystep_blocks.h. */
#include "carrystep_blocks.h"

#include <string.h>

#define TWO_32 4294967296.0
#define TWO_64 (TWO_32 * TWO_32)

/* Commands must be less than this from zero: the position register has 32 bits. */
#define MOST_STEPS 2147483648.0

/* Greatest speed of a segment, steps per tick: the engine takes less than half a step. */
#define MOST_SPEED 0.499

/* How far a command may exceed the greatest speed, as a factor: its rounding. */
#define TOLERANCE 1.001

#define PARTS INT64_C(1000000000)

static double magnitude(double x)
{
    return x < 0 ? -x : x;
}

carrystep_place carrystep_place_of(double steps)
{
    int64_t whole = (int64_t)steps;
    double part = steps - (double)whole; /* exact: its bits are some of those of `steps` */
    int64_t high = (int64_t)(part * TWO_32);
    int64_t low = (int64_t)((part * TWO_32 - (double)high) * TWO_32);
    carrystep_place unit = (carrystep_place)1 << 32;
    return ((carrystep_place)whole * unit + high) * unit + low;
}

double carrystep_steps_of(carrystep_place place)
{
    int64_t whole = (int64_t)(place / ((carrystep_place)1 << 64));
    carrystep_place part = place - (carrystep_place)whole * ((carrystep_place)1 << 64);
    return (double)whole + (double)part / TWO_64;
}

carrystep_place carrystep_distance(const carrystep_segment *segment, uint32_t ticks)
{
    carrystep_place n = ticks;
    carrystep_place way = n * segment->v;
    if (segment->a != 0 || segment->j != 0) {
        way += n * (n - 1) / 2 * segment->a + n * (n - 1) * (n - 2) / 6 * segment->j;
    }
    return way;
}

bool carrystep_cubic(uint32_t ticks, carrystep_place distance, double v0, double v1, carrystep_segment *segment)
{
    double n = (double)ticks;
    double d = carrystep_steps_of(distance);
    /* x(t) = v0 t + a t^2 / 2 + j t^3 / 6 */
    double a = (6.0 * d / n - 4.0 * v0 - 2.0 * v1) / n;
    double j = (6.0 * (v0 + v1) - 12.0 * d / n) / (n * n);
    double turn = j != 0 ? -a / j : -1.0;
    double fastest = turn > 0 && turn < n ? magnitude(v0 + a * turn / 2.0) : 0.0;
    carrystep_place rest;
    memset(segment, 0, sizeof *segment);
    segment->ticks = ticks;
    /* Negated, so that a speed that is not a number is refused. */
    if (!(magnitude(v0) < MOST_SPEED && magnitude(v1) < MOST_SPEED && fastest < MOST_SPEED &&
          magnitude(d) < MOST_SPEED * n)) {
        return false;
    }
    /* A in the middle of the first tick, as the discrete sum needs it. |a| < 6 and |j| < 12 for one
     * tick, so a short segment may exceed what A and J hold. */
    if (!(magnitude(a) + magnitude(j) < MOST_SPEED)) {
        return false;
    }
    segment->j = (int64_t)(j * TWO_64);
    segment->a = (int64_t)((a + j) * TWO_64);
    /* V takes up what rounding of A and J did. What is less than one unit of V is left for the next
     * segment. Rounding toward 0 keeps an axis at rest: to the nearest, V could alternate between 1
     * and -1. */
    rest = distance - carrystep_distance(segment, ticks);
    segment->v = (int64_t)(rest / (carrystep_place)ticks);
    return true;
}

bool carrystep_blocks_begin(carrystep_blocks *blocks, uint32_t stream, uint8_t axes, uint32_t periods,
                            uint32_t period_ns, uint32_t tick_ns, const carrystep_place *at, const double *most)
{
    uint64_t ns = (uint64_t)periods * period_ns;
    memset(blocks, 0, sizeof *blocks);
    if (axes > CARRYSTEP_MOST_AXES || periods == 0 || periods > CARRYSTEP_MOST_PERIODS || tick_ns == 0 ||
        ns / tick_ns < 2u || ns / tick_ns > CARRYSTEP_MOST_BLOCK_TICKS / 2u || ns > (uint64_t)PARTS) {
        return false;
    }
    blocks->stream = stream;
    blocks->axes = axes;
    blocks->periods = periods;
    blocks->period_ns = period_ns;
    blocks->tick_ns = tick_ns;
    for (uint8_t axis = 0; axis < axes; axis++) {
        double steps = carrystep_steps_of(at[axis]);
        blocks->axis[axis].at = at[axis];
        blocks->axis[axis].latest = steps;
        blocks->axis[axis].previous = steps;
        blocks->axis[axis].end = steps;
        blocks->axis[axis].before = steps;
        blocks->axis[axis].most = most[axis] * (double)period_ns * 1e-9 * TOLERANCE + 1e-6;
    }
    return true;
}

/* Refuses commands that nothing can follow. */
static carrystep_taken check(carrystep_blocks *blocks, const double *steps)
{
    for (uint8_t axis = 0; axis < blocks->axes; axis++) {
        blocks->culprit = axis;
        if (!(magnitude(steps[axis]) <= 1e300)) {
            return CARRYSTEP_NOT_A_NUMBER;
        }
        if (magnitude(steps[axis]) >= MOST_STEPS) {
            return CARRYSTEP_OUT_OF_RANGE;
        }
        if (magnitude(steps[axis] - blocks->axis[axis].latest) > blocks->axis[axis].most) {
            return CARRYSTEP_JUMP;
        }
    }
    return CARRYSTEP_NO_BLOCK;
}

/* Number of ticks of the next block. The part of a tick that is left over belongs to the one after
 * it. */
static uint32_t length(carrystep_blocks *blocks, int32_t trim)
{
    int64_t most = PARTS / 100;
    int64_t bounded = trim > most ? most : trim < -most ? -most : trim;
    int64_t ns = (int64_t)blocks->periods * (int64_t)blocks->period_ns;
    /* ns is at most 10^9, so that the product is at most 1.01 x 10^18. */
    int64_t whole = ns * (PARTS + bounded) + blocks->remainder;
    int64_t tick = (int64_t)blocks->tick_ns * PARTS;
    blocks->remainder = whole % tick;
    return (uint32_t)(whole / tick);
}

/* The block that ended one period ago. */
static carrystep_taken finish(carrystep_blocks *blocks, int32_t trim, carrystep_block *block)
{
    uint32_t ticks = length(blocks, trim);
    double period = (double)ticks / (double)blocks->periods;
    memset(block, 0, sizeof *block);
    block->stream = blocks->stream;
    block->before = blocks->ticks;
    for (uint8_t axis = 0; axis < blocks->axes; axis++) {
        double speed = (blocks->axis[axis].latest - blocks->axis[axis].before) / 2.0 / period;
        carrystep_place at = blocks->axis[axis].at;
        carrystep_place way = carrystep_place_of(blocks->axis[axis].end) - at;
        blocks->culprit = axis;
        if (!carrystep_cubic(ticks, way, blocks->axis[axis].speed, speed, &block->axes[axis])) {
            return CARRYSTEP_TOO_FAST;
        }
        block->at[axis] = at;
        blocks->axis[axis].at = at + carrystep_distance(&block->axes[axis], ticks);
        blocks->axis[axis].speed = speed;
    }
    block->axes[0].outputs = blocks->outputs;
    blocks->outputs = blocks->next_outputs;
    blocks->ticks += ticks;
    return CARRYSTEP_A_BLOCK;
}

carrystep_taken carrystep_blocks_take(carrystep_blocks *blocks, const double *steps, uint32_t outputs, int32_t trim,
                                      carrystep_block *block)
{
    carrystep_taken taken = check(blocks, steps);
    if (taken != CARRYSTEP_NO_BLOCK) {
        return taken;
    }
    for (uint8_t axis = 0; axis < blocks->axes; axis++) {
        blocks->axis[axis].previous = blocks->axis[axis].latest;
        blocks->axis[axis].latest = steps[axis];
    }
    if (blocks->ticks == 0 && blocks->seen == 0) {
        blocks->outputs = outputs; /* the first period of the stream */
    }
    blocks->seen++;
    if (blocks->seen > blocks->periods) {
        taken = finish(blocks, trim, block);
        blocks->seen = 1;
    }
    if (blocks->seen == blocks->periods) {
        blocks->next_outputs = outputs;
        for (uint8_t axis = 0; axis < blocks->axes; axis++) {
            blocks->axis[axis].end = blocks->axis[axis].latest;
            blocks->axis[axis].before = blocks->axis[axis].previous;
        }
    }
    return taken;
}

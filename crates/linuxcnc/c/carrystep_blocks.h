/* Position commands of a servo thread, one per period, as cubic segments of the engine.
 *
 * A block is k servo periods. Over a block each axis follows the cubic (Hermite) that begins and
 * ends at the commands of the block's ends, with the speeds that the commands before and behind
 * these ends show. So position and speed are continuous from block to block. A block is known one
 * period after its end.
 *
 * Outputs switch where a block begins, and never before the motion with which they were commanded:
 * what they are at the end of a block is what they are from there on.
 *
 * Places are exact: integers of 2^-64 step. A segment of n ticks ends less than n of these units
 * from the command, and the next segment begins where it really ends, so that rounding never adds
 * up. This needs a compiler with 128-bit integers: GCC or Clang for a 64-bit processor.
 *
 * Nothing here blocks, allocates or calls the operating system. */
#ifndef CARRYSTEP_BLOCKS_H
#define CARRYSTEP_BLOCKS_H

#include "carrystep_frame.h"

__extension__ typedef __int128 carrystep_place; /* 2^-64 step */

/* Greatest number of servo periods in a block. */
#define CARRYSTEP_MOST_PERIODS 64u

/* Greatest number of ticks in a block: products with their cubes fit 128 bits. */
#define CARRYSTEP_MOST_BLOCK_TICKS (1u << 20)

/* A block of all axes. */
typedef struct {
    uint32_t stream;    /* number of the stream that it belongs to */
    uint64_t before;    /* ticks of all earlier blocks of the stream */
    carrystep_place at[CARRYSTEP_MOST_AXES]; /* where the axes are when it begins */
    carrystep_segment axes[CARRYSTEP_MOST_AXES];
} carrystep_block;

typedef enum {
    CARRYSTEP_NO_BLOCK,     /* taken; the block is not complete */
    CARRYSTEP_A_BLOCK,      /* taken, and *block is set */
    CARRYSTEP_NOT_A_NUMBER, /* a command is not a finite number */
    CARRYSTEP_OUT_OF_RANGE, /* a command is 2^31 steps from zero, or further */
    CARRYSTEP_JUMP,         /* a command is further from the one before than the greatest speed allows */
    CARRYSTEP_TOO_FAST      /* a cubic would be faster than the engine can run */
} carrystep_taken;

/* The commands of a stream. Begins with carrystep_blocks_begin. */
typedef struct {
    uint8_t axes;
    uint32_t periods;     /* in a block */
    uint32_t period_ns;   /* of the servo thread */
    uint32_t tick_ns;     /* of the engine */
    uint32_t seen;        /* periods since the beginning of the block */
    int64_t remainder;    /* part of a tick that the next block makes up for: 10^-9 of a ns */
    uint64_t ticks;       /* of all blocks of this stream */
    uint32_t stream;
    uint32_t culprit;     /* the axis whose command was refused */
    uint32_t outputs;     /* of the block that waits for its speed, as in carrystep_segment */
    uint32_t next_outputs; /* of the block behind it */
    struct {
        double most;      /* greatest steps in a period */
        double latest;    /* the latest command, steps */
        double previous;  /* the command before it */
        double end;       /* the command at the end of the block that waits for its speed */
        double before;    /* the command one period before `end` */
        double speed;     /* steps per tick where the block begins */
        carrystep_place at; /* where the last segment ended */
    } axis[CARRYSTEP_MOST_AXES];
} carrystep_blocks;

/* Begins stream `stream` with all axes at rest at `at`. `periods` is 1 to CARRYSTEP_MOST_PERIODS.
 * `most` are the greatest speeds, steps/s. False if these numbers make no block: it would have no
 * tick, or more than CARRYSTEP_MOST_BLOCK_TICKS. */
bool carrystep_blocks_begin(carrystep_blocks *blocks, uint32_t stream, uint8_t axes, uint32_t periods,
                            uint32_t period_ns, uint32_t tick_ns, const carrystep_place *at, const double *most);

/* Takes the commands of the next servo period: places in steps, and `outputs` as in
 * carrystep_segment. Segments are longer than the periods by `trim` parts per 10^9, at most 10^7 in
 * either direction. After a refusal the stream has ended. */
carrystep_taken carrystep_blocks_take(carrystep_blocks *blocks, const double *steps, uint32_t outputs, int32_t trim,
                                      carrystep_block *block);

/* The cubic over `ticks` ticks (1 to CARRYSTEP_MOST_BLOCK_TICKS) and `distance`, 2^-64 step, that
 * begins with the speed `v0` and ends with `v1`, steps per tick. False if it is too fast. */
bool carrystep_cubic(uint32_t ticks, carrystep_place distance, double v0, double v1, carrystep_segment *segment);

/* The distance of a segment after `ticks` of its ticks. Segments with A and J of 0 may have any
 * length, others CARRYSTEP_MOST_BLOCK_TICKS. */
carrystep_place carrystep_distance(const carrystep_segment *segment, uint32_t ticks);

/* Steps (less than 2^31) as a place, where bits below 2^-64 step are cut off; and back, rounded. */
carrystep_place carrystep_place_of(double steps);
double carrystep_steps_of(carrystep_place place);

#endif

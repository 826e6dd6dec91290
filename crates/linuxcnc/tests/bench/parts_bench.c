/* Blocks, trim and ring, through standard input and output: a line is answered by a line. */
#include "carrystep_blocks.h"
#include "carrystep_ring.h"
#include "carrystep_trim.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

/* "axes periods period_ns tick_ns trim most ..." begins; then "command ..." in steps for each
 * period. Answers: the outcome; for a block also ticks, and v a j of each axis. */
static int blocks(void)
{
    static carrystep_blocks stream;
    static carrystep_block block;
    carrystep_place at[16];
    double most[16], steps[16];
    unsigned axes, periods, period_ns, tick_ns;
    int trim;
    if (scanf("%u %u %u %u %d", &axes, &periods, &period_ns, &tick_ns, &trim) != 5 || axes > 16) {
        return 1;
    }
    memset(at, 0, sizeof at);
    for (unsigned axis = 0; axis < axes; axis++) {
        if (scanf("%lf", &most[axis]) != 1) {
            return 1;
        }
    }
    printf("%d\n", carrystep_blocks_begin(&stream, 1, (uint8_t)axes, periods, period_ns, tick_ns, at, most));
    fflush(stdout);
    for (;;) {
        for (unsigned axis = 0; axis < axes; axis++) {
            if (scanf("%lf", &steps[axis]) != 1) {
                return 0;
            }
        }
        carrystep_taken taken = carrystep_blocks_take(&stream, steps, 0, trim, &block);
        printf("%d %u", (int)taken, stream.culprit);
        if (taken == CARRYSTEP_A_BLOCK) {
            printf(" %" PRIu32, block.axes[0].ticks);
            for (unsigned axis = 0; axis < axes; axis++) {
                printf(" %" PRId64 " %" PRId64 " %" PRId64, block.axes[axis].v, block.axes[axis].a, block.axes[axis].j);
            }
        }
        printf("\n");
        fflush(stdout);
    }
}

/* "ticks distance v0 v1", in steps and steps per tick: "1 v a j", or "0". */
static int cubic(void)
{
    unsigned ticks;
    double distance, v0, v1;
    while (scanf("%u %lf %lf %lf", &ticks, &distance, &v0, &v1) == 4) {
        carrystep_segment segment;
        bool fits = carrystep_cubic(ticks, carrystep_place_of(distance), v0, v1, &segment);
        if (fits) {
            printf("1 %" PRId64 " %" PRId64 " %" PRId64 "\n", segment.v, segment.a, segment.j);
        } else {
            printf("0\n");
        }
        fflush(stdout);
    }
    return 0;
}

/* "horizon" begins; then "lead faster": the trim. */
static int trim(void)
{
    carrystep_trim state;
    int64_t horizon, lead, faster;
    if (scanf("%" SCNd64, &horizon) != 1) {
        return 1;
    }
    carrystep_trim_begin(&state, horizon);
    printf("0\n");
    fflush(stdout);
    while (scanf("%" SCNd64 " %" SCNd64, &lead, &faster) == 2) {
        printf("%" PRId32 "\n", carrystep_trim_take(&state, lead, faster));
        fflush(stdout);
    }
    return 0;
}

typedef struct {
    uint64_t number, square;
} element;

static carrystep_ring ring_of_both;

static void *put_all(void *context)
{
    uint64_t count = *(uint64_t *)context;
    for (uint64_t number = 0; number < count;) {
        element next = {number, number * number};
        number += carrystep_ring_put(&ring_of_both, &next) ? 1u : 0u;
    }
    return NULL;
}

/* "count": puts so many elements in one thread and takes them in another; answers how many came
 * whole and in order. */
static int ring(void)
{
    static element cells[16];
    uint64_t count, good = 0;
    pthread_t other;
    if (scanf("%" SCNu64, &count) != 1) {
        return 1;
    }
    carrystep_ring_begin(&ring_of_both, cells, sizeof cells[0], 16);
    if (pthread_create(&other, NULL, put_all, &count) != 0) {
        return 1;
    }
    for (uint64_t number = 0; number < count;) {
        element next;
        if (carrystep_ring_take(&ring_of_both, &next)) {
            good += next.number == number && next.square == number * number ? 1u : 0u;
            number++;
        }
    }
    pthread_join(other, NULL);
    printf("%" PRIu64 "\n", good);
    return 0;
}

int main(int count, char **words)
{
    const char *mode = count > 1 ? words[1] : "";
    return strcmp(mode, "blocks") == 0  ? blocks()
           : strcmp(mode, "cubic") == 0 ? cubic()
           : strcmp(mode, "trim") == 0  ? trim()
           : strcmp(mode, "ring") == 0  ? ring()
                                        : 1;
}

/* The feeder: sends the segments of a program in the order in which the queues need them, and each
 * start as early as possible.
 *
 * C99, without allocation and floating point. */
#ifndef CARRYSTEP_FEEDER_H
#define CARRYSTEP_FEEDER_H

#include "carrystep_session.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A source of segments and starts. Each of them is requested once; false means that there are no
 * more. */
typedef struct {
    bool (*segment)(void *context, uint8_t axis, carrystep_segment *segment);
    bool (*start)(void *context, uint8_t *mask);
    void *context;
} carrystep_source;

/* A program that is being sent; initialised by carrystep_load. */
typedef struct {
    carrystep_source source;
    struct {
        carrystep_segment ahead; /* the next segment, if `has` is set */
        bool has;
        bool dry;         /* the source has no more segments */
        bool open;        /* the last segment sent was not the last of its move */
        uint32_t waiting; /* moves whose first segment was sent and whose start was not */
        uint64_t ticks;   /* sum of the ticks of all segments sent */
    } axes[CARRYSTEP_MOST_AXES];
    uint8_t start;
    bool has_start;
    bool last_start;
} carrystep_feeder;

typedef enum {
    CARRYSTEP_FEEDING,    /* a part of the program was not queued yet */
    CARRYSTEP_FED,        /* the whole program was queued */
    CARRYSTEP_BAD_SOURCE, /* a segment of 0 ticks, or a start without a move. Stop the axes: the
                             queues will run empty. */
    CARRYSTEP_NO_POWER    /* a start is due, but the drivers have no power: write CONTROL = 1, wait
                             for `ready`, and continue */
} carrystep_fed;

/* Begins to send a program from its beginning. */
void carrystep_load(carrystep_feeder *feeder, carrystep_source source);

/* Queues as much of the program as there is room for. */
carrystep_fed carrystep_feed(carrystep_session *session, carrystep_feeder *feeder);

#ifdef __cplusplus
}
#endif

#endif

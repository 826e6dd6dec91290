/* The segments of a program as the queues have room, and each start as soon as it may be sent.
 *
 * C99; no allocation, no floating point. */
#ifndef CARRYSTEP_FEEDER_H
#define CARRYSTEP_FEEDER_H

#include "carrystep_session.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where segments come from. Each is asked for once; false means that there are no more. */
typedef struct {
    bool (*segment)(void *context, uint8_t axis, carrystep_segment *segment);
    bool (*start)(void *context, uint8_t *mask);
    void *context;
} carrystep_source;

/* A program on its way into the queues; carrystep_load makes one. */
typedef struct {
    carrystep_source source;
    struct {
        carrystep_segment ahead; /* the next one, where `has` */
        bool has;
        bool dry;         /* the source has no more */
        bool open;        /* in the middle of a move */
        uint32_t waiting; /* moves that were begun and not started */
        uint64_t ticks;   /* of all segments that were sent */
    } axes[CARRYSTEP_MOST_AXES];
    uint8_t start;
    bool has_start;
    bool last_start;
} carrystep_feeder;

typedef enum {
    CARRYSTEP_FEEDING,    /* there is more */
    CARRYSTEP_FED,        /* all was handed over */
    CARRYSTEP_BAD_SOURCE, /* a segment of no ticks, or a start without a move: what was queued will run dry, so stop */
    CARRYSTEP_NO_POWER    /* a start is due and the drivers have no power: write CONTROL = 1, wait for `ready`, go on */
} carrystep_fed;

/* A program from its beginning. */
void carrystep_load(carrystep_feeder *feeder, carrystep_source source);

/* Hands over as much of the program as there is room for. */
carrystep_fed carrystep_feed(carrystep_session *session, carrystep_feeder *feeder);

#ifdef __cplusplus
}
#endif

#endif

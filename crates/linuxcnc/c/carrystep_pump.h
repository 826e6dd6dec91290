/* The other thread's side: connects to the board, sends the blocks of the real-time function, takes
 * snapshots, and reports. It gets bytes and the time from its caller, so it works on any line and
 * in tests without one.
 *
 *     ASKING -> OPENING -> STOPPING -> LOOKING -> IDLE -> POWERING -> RUNNING
 *                             ^                    ^         |           |
 *                             +--------------------|---------+-----------+
 *
 * A stream always ends with a STOP: the axes ramp down if they move, the queues are emptied, and
 * after CLEAR slots count from 0. */
#ifndef CARRYSTEP_PUMP_H
#define CARRYSTEP_PUMP_H

#include "carrystep_facts.h"
#include "carrystep_latches.h"
#include "carrystep_servo.h"
#include "carrystep_time.h"
#include "carrystep_trim.h"

typedef enum {
    CARRYSTEP_PUMP_ASKING,
    CARRYSTEP_PUMP_OPENING,
    CARRYSTEP_PUMP_STOPPING,
    CARRYSTEP_PUMP_LOOKING,
    CARRYSTEP_PUMP_IDLE,
    CARRYSTEP_PUMP_POWERING,
    CARRYSTEP_PUMP_RUNNING,
    CARRYSTEP_PUMP_GONE /* the board does not answer, or is not ours: the caller closes the line */
} carrystep_pump_state;

typedef struct {
    uint8_t axes;        /* joints; the build may have more axes, which stay at rest */
    uint64_t build;      /* build id that is required; 0: any */
    uint64_t horizon_ns; /* lead of the blocks over the pins */
    uint16_t number;     /* session, 1 to 65535, random */
    uint8_t probe_latch; /* the latch of the probe's pin, or CARRYSTEP_NO_LATCH */
    uint8_t index_latch; /* the latch of index pulses, another one, or CARRYSTEP_NO_LATCH */
    uint8_t window;      /* greatest number of unacknowledged writes; 0: CARRYSTEP_SLOTS */
} carrystep_pump_how;

typedef struct {
    carrystep_shared *shared;
    carrystep_pump_how how;
    carrystep_session session;
    carrystep_pump_state state;
    carrystep_report report;
    uint64_t now;    /* us */
    uint64_t since;  /* us, when this state began */
    uint64_t heard;  /* us, when the last answer came */
    uint64_t polled;
    uint64_t cleared; /* us, when CLEAR was tried last */
    carrystep_facts facts;
    carrystep_answer answer; /* the latest */
    bool fresh;              /* an answer has come since this state began */
    bool stopped;            /* STOPPING: STOP was sent */
    bool clearing;           /* STOPPING: CLEAR was sent */
    uint32_t stream;
    uint64_t rest;           /* ticks of the segment of rest before the first block */
    carrystep_sent sent;
    carrystep_look look;
    uint64_t made;           /* ticks of blocks made at the last snapshot */
    carrystep_latches latches;
    carrystep_ticks ticks;
    carrystep_clocks clocks;
    carrystep_trim trim;
} carrystep_pump;

/* Begins a connection at the time `now_us`. */
void carrystep_pump_begin(carrystep_pump *pump, carrystep_shared *shared, const carrystep_pump_how *how,
                          uint64_t now_us);

/* Decides what to send next. Call it after bytes came, and at least every ms. */
void carrystep_pump_run(carrystep_pump *pump, uint64_t now_us);

/* The next request for the line, CARRYSTEP_LINE_BYTES at most; 0: nothing now. */
size_t carrystep_pump_transmit(carrystep_pump *pump, uint64_t now_us, uint8_t *line);

/* Takes a byte from the line. */
void carrystep_pump_receive(carrystep_pump *pump, uint64_t now_us, uint8_t byte);

/* Reports that there is no line, and why. */
void carrystep_pump_away(carrystep_shared *shared, uint32_t fault);

#endif

/* What the thread reads of the board again and again: the state of all axes in one tick
 * (SNAPSHOT) and the inputs; and where latches are used, which of them are armed, and the record of
 * one that has found its edge. Nothing here knows what it is for. */
#ifndef CARRYSTEP_LOOK_H
#define CARRYSTEP_LOOK_H

#include "carrystep_feedback.h"
#include "carrystep_session.h"

/* No latch. */
#define CARRYSTEP_NO_LATCH 0xffu

typedef enum {
    CARRYSTEP_LOOK_NONE,
    CARRYSTEP_LOOK_WRITTEN,  /* SNAPSHOT is on its way */
    CARRYSTEP_LOOK_READING,  /* its registers are read */
    CARRYSTEP_LOOK_CHOSEN,   /* the latch to read is on its way */
    CARRYSTEP_LOOK_RECORDING /* the registers of the latch are read */
} carrystep_look_stage;

/* What has become whole. */
typedef enum {
    CARRYSTEP_LOOK_NOTHING,
    CARRYSTEP_LOOK_SNAPSHOT,
    CARRYSTEP_LOOK_RECORD
} carrystep_look_event;

typedef struct {
    uint8_t axes;
    bool latched;      /* latches are used */
    carrystep_look_stage stage;
    uint64_t begun;    /* us, when the last snapshot began */
    uint32_t count;    /* blocks sent before it */
    uint64_t before;   /* us */
    uint64_t after;
    uint64_t missing;  /* registers not read yet, one bit each */
    uint32_t ticks;    /* SNAPSHOT_TICKS */
    uint32_t inputs;   /* INPUTS, read behind the snapshot */
    uint32_t levels;   /* INPUT_LEVELS, likewise: not debounced */
    uint32_t captures; /* CAPTURES, read behind the inputs */
    uint32_t latches;  /* LATCHES, likewise */
    uint8_t latch;     /* whose record is read */
    carrystep_seen seen[CARRYSTEP_MOST_AXES];
    carrystep_seen record[CARRYSTEP_MOST_AXES]; /* `left` has no meaning */
} carrystep_look;

/* Begins a snapshot if none is under way and a write fits; `count` blocks have been sent. Never
 * before the last one is complete: its reads and those of the next have the same addresses, and a
 * mixture of both would be a place where no axis ever was. */
bool carrystep_look_begin(carrystep_look *look, carrystep_session *session, uint64_t now, uint32_t count);

/* Asks for the registers that are missing. */
void carrystep_look_read(carrystep_look *look, carrystep_session *session);

/* Takes an answer. Behind CARRYSTEP_LOOK_SNAPSHOT the caller may ask for a record. */
carrystep_look_event carrystep_look_take(carrystep_look *look, carrystep_session *session, uint64_t now,
                                         const carrystep_answer *answer);

/* Begins to read the record of a latch. False if no write fits. */
bool carrystep_look_record(carrystep_look *look, carrystep_session *session, uint8_t latch);

/* Whether the latch is armed, as of the last snapshot. */
bool carrystep_look_armed(const carrystep_look *look, uint8_t latch);

/* Arms a latch. False if no write fits. */
bool carrystep_look_arm(const carrystep_look *look, carrystep_session *session, uint8_t latch);

#endif

/* One host's talk with one gateware: writes that are executed once and in order, questions that are asked again. Bytes
 * and milliseconds come from outside:
 *
 *     static carrystep_session link;
 *     static carrystep_feeder program;
 *     carrystep_begin(&link, 40, 2);
 *     carrystep_read(&link, CARRYSTEP_IDENTITY); ...       then carrystep_check() and carrystep_adopt()
 *     for (;;) {
 *         uint8_t line[CARRYSTEP_LINE_BYTES];
 *         carrystep_feed(&link, &program);
 *         size_t length = carrystep_transmit(&link, now(), line);   put `length` bytes on the line
 *         ... each byte that comes: carrystep_receive(&link, byte, now(), &answer)
 *     }
 *
 * Over SPI the bytes go both ways at once; send CARRYSTEP_END while there is nothing to say. */
#ifndef CARRYSTEP_SESSION_H
#define CARRYSTEP_SESSION_H

#include "carrystep_frame.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Writes that may be on their way, 1 to CARRYSTEP_WINDOW; about 48 bytes of memory each. */
#ifndef CARRYSTEP_SLOTS
#define CARRYSTEP_SLOTS 16
#endif

/* All fields belong to the functions below. */
typedef struct {
    carrystep_decoder decoder;
    uint32_t resend;
    uint32_t pause;
    /* writes: a ring of slots */
    carrystep_request slots[CARRYSTEP_SLOTS];
    uint8_t at;
    uint8_t length;
    uint8_t first;
    uint8_t sent;
    uint8_t reached;
    uint32_t since;
    uint8_t refused;
    bool has_refused;
    bool busy;
    /* questions */
    struct {
        uint8_t address;
        uint8_t sequence;
        bool open;
        bool asked;
        uint32_t when;
    } reads[CARRYSTEP_MOST_AXES];
    uint8_t read_sequence;
    /* the gateware */
    uint8_t axes;
    uint8_t under_way[CARRYSTEP_MOST_AXES];
    uint8_t room[CARRYSTEP_MOST_AXES];
    bool starting;
    bool armed;
    bool unpowered; /* the last answer came from drivers without power */
    bool powering;  /* this host has asked for power */
} carrystep_session;

typedef enum {
    CARRYSTEP_QUIET,      /* no answer has ended */
    CARRYSTEP_HEARD,      /* *answer is one */
    CARRYSTEP_DAMAGED,    /* a damaged frame: it will be asked for again */
    CARRYSTEP_OUT_OF_STEP /* the gateware was restarted, or another host writes to it or is answered: begin anew */
} carrystep_event;

typedef enum {
    CARRYSTEP_FINE,
    CARRYSTEP_OTHER_DEVICE,   /* it is not carrystep */
    CARRYSTEP_OTHER_PROTOCOL, /* another version */
    CARRYSTEP_OTHER_BUILD     /* gateware of another machine */
} carrystep_verdict;

/* Whether gateware whose registers say this may be driven by a host made for build `wanted`. */
carrystep_verdict carrystep_check(uint32_t identity, uint32_t protocol, uint64_t build, uint64_t wanted);

/* A fresh session: registers may be read, nothing may be written. `resend`: ms to wait for an answer before the request
 * is sent again, more than the line ever takes; `pause`: ms to wait where the gateware is busy. */
void carrystep_begin(carrystep_session *session, uint32_t resend, uint32_t pause);

/* From here on writes are numbered from `next`, which the last answer gave; the build has so many axes. */
void carrystep_adopt(carrystep_session *session, uint8_t next, uint8_t axes);

/* Reads a register: its answer comes out of carrystep_receive. False: eight are being read already. */
bool carrystep_read(carrystep_session *session, uint8_t address);

/* Whether a START is taken, at once or after a while. False: the drivers have no power, and the gateware would refuse the
 * START, and all that is behind it, for as long as they have none: write CONTROL = 1 and wait for `ready`. */
bool carrystep_may_start(const carrystep_session *session);

/* Writes a register. False: no room, not adopted yet, or a START where carrystep_may_start says no. */
bool carrystep_write(carrystep_session *session, uint8_t address, uint32_t word);

/* Puts a segment into the queue of an axis; mind session->room. False: no room on the way, no such axis, no ticks, or not
 * adopted yet. carrystep_feed does it for whole programs. */
bool carrystep_put(carrystep_session *session, uint8_t axis, const carrystep_segment *segment);

/* Whether an answer is still to come; whether writes were not seen executed yet. */
bool carrystep_waiting(const carrystep_session *session);
bool carrystep_writing(const carrystep_session *session);

/* Takes back the writes that were never sent, so that the next one, a stop, goes out at once. */
void carrystep_withdraw(carrystep_session *session);

/* Puts the next request on `line` (CARRYSTEP_LINE_BYTES): how many bytes, 0 where there is nothing to send now. */
size_t carrystep_transmit(carrystep_session *session, uint32_t now, uint8_t *line);

/* A byte from the line. */
carrystep_event carrystep_receive(carrystep_session *session, uint8_t byte, uint32_t now, carrystep_answer *answer);

#ifdef __cplusplus
}
#endif

#endif

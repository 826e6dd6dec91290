/* The dialogue of one host with one gateware. Writes are executed in order, each exactly once;
 * reads without an answer are sent again. The caller passes the bytes and the time in milliseconds:
 *
 *     static carrystep_session link;
 *     static carrystep_feeder program;
 *     carrystep_begin(&link, 40, 2);
 *     carrystep_read(&link, CARRYSTEP_IDENTITY); ...    then carrystep_check()
 *     carrystep_open(&link, number, axes); ...          until carrystep_owns(): busy is asked again
 *     for (;;) {
 *         uint8_t line[CARRYSTEP_LINE_BYTES];
 *         carrystep_feed(&link, &program);
 *         size_t length = carrystep_transmit(&link, now(), line);   put `length` bytes on the line
 *         ... each byte that comes: carrystep_receive(&link, byte, now(), &answer)
 *     }
 *
 * SPI transfers bytes in both directions at once; send CARRYSTEP_END while there is nothing else to
 * send. */
#ifndef CARRYSTEP_SESSION_H
#define CARRYSTEP_SESSION_H

#include "carrystep_frame.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Greatest number of unacknowledged writes, 1 to CARRYSTEP_WINDOW; each needs about 48 bytes of
 * memory. */
#ifndef CARRYSTEP_SLOTS
#define CARRYSTEP_SLOTS 16
#endif

/* The state of a session. Only the functions below may change its fields. */
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
    uint8_t limit;
    uint32_t since;
    uint8_t refused;
    bool has_refused;
    bool busy;
    /* requests outside of the sequence: reads, then OPEN and STOP */
    struct {
        carrystep_request request;
        uint8_t sequence;
        bool open;
        bool asked;
        uint32_t when;
        uint8_t order;   /* its place in the order of these requests */
        uint8_t before;  /* sequence number of the next write that was to be sent then */
        bool overtaken;  /* a request that was sent behind it was answered */
        bool sent_again; /* it was sent again for that reason, and waits for its time */
    } singles[CARRYSTEP_MOST_AXES + 2u];
    uint8_t single_sequence;
    uint8_t single_order;
    /* the gateware */
    uint16_t number;  /* the session that this host owns; 0: none */
    uint16_t opening; /* the session that it has asked for; 0: none */
    uint8_t axes;
    uint8_t under_way[CARRYSTEP_MOST_AXES];
    uint8_t room[CARRYSTEP_MOST_AXES];
    bool starting;
    bool armed;
    bool unpowered; /* the last answer came from drivers without power */
    bool powering;  /* this host has asked for power */
    bool seek_ended;
    bool cut_refused;
    bool keeps_refused_cut; /* no other write has been acknowledged since a cut was refused */
    uint8_t refused_cut;    /* its sequence number */
} carrystep_session;

typedef enum {
    CARRYSTEP_QUIET,   /* the byte completes no answer */
    CARRYSTEP_HEARD,   /* the byte completes an answer, and *answer is set */
    CARRYSTEP_DAMAGED, /* the byte ends a damaged frame; the request will be sent again */
    CARRYSTEP_LOST     /* *answer says that the gateware does not keep this session any more: another
                          host has opened one, or the gateware was restarted. This host owns none from
                          now on: stop, open and clear, or leave the gateware to the other host. */
} carrystep_event;

typedef enum {
    CARRYSTEP_FINE,
    CARRYSTEP_OTHER_DEVICE,   /* the device is not carrystep */
    CARRYSTEP_OTHER_PROTOCOL, /* the gateware has another version of the protocol */
    CARRYSTEP_OTHER_BUILD     /* the gateware was built for another machine */
} carrystep_verdict;

/* Checks that a host made for build `wanted` may drive the gateware with these register values. */
carrystep_verdict carrystep_check(uint32_t identity, uint32_t protocol, uint64_t build, uint64_t wanted);

/* Begins the dialogue, without a session: registers may be read, and the axes may be stopped.
 * `resend`: time without an answer, ms, until a request is sent again; it must exceed the delay of
 * the line. `pause`: time until a request that was refused as busy is sent again, ms. */
void carrystep_begin(carrystep_session *session, uint32_t resend, uint32_t pause);

/* Has at most `writes` writes on the line that are not acknowledged; the others wait. 1 to
 * CARRYSTEP_SLOTS, which is the number without this call. Over SPI it must be 6 or less
 * (docs/protocol.md). */
void carrystep_limit(carrystep_session *session, uint8_t writes);

/* Asks for a session with this number, 1 to 65535, with a build of `axes` axes. It is granted if no
 * axis moves and no segment waits, or if a stop is complete; then carrystep_owns returns true.
 * Otherwise the answer has CARRYSTEP_REASON_BUSY: ask again, or stop the axes before. Writes of an
 * earlier session are forgotten. */
void carrystep_open(carrystep_session *session, uint16_t number, uint8_t axes);

/* Whether carrystep_open has no answer yet; whether this host owns a session. */
bool carrystep_opening(const carrystep_session *session);
bool carrystep_owns(const carrystep_session *session);

/* Stops all axes, each with its ramp, of whichever host. No session is needed. Writes that were
 * never sent are removed. After the stop (`halted`), write CLEAR. */
void carrystep_stop(carrystep_session *session);

/* Whether carrystep_stop has no answer yet. */
bool carrystep_stopping(const carrystep_session *session);

/* Starts to read a register; carrystep_receive returns the answer. False if eight are being read.
 */
bool carrystep_read(carrystep_session *session, uint8_t address);

/* Whether the gateware will accept a START, at once or after a while. False if the drivers have no
 * power: the gateware would refuse the START, and all writes behind it, as long as they have none.
 * Write CONTROL = 1 first and wait for `ready`. */
bool carrystep_may_start(const carrystep_session *session);

/* Queues a write of a register. False if there is no room, if this host owns no session, or for a
 * START if carrystep_may_start returns false. */
bool carrystep_write(carrystep_session *session, uint8_t address, uint32_t word);

/* Queues a segment for an axis. The caller must observe session->room. False if there is no room
 * for a write, no such axis, no tick in the segment, or if this host owns no session.
 * carrystep_feed calls this for whole programs. */
bool carrystep_put(carrystep_session *session, uint8_t axis, const carrystep_segment *segment);

/* Whether any answer is outstanding; whether any write is unacknowledged. */
bool carrystep_waiting(const carrystep_session *session);
bool carrystep_writing(const carrystep_session *session);

/* Whether the gateware has refused a segment or a START because one of its axes has hit the source
 * of its seek. That write and all behind it were removed, since none of them can be executed, and
 * carrystep_feed queues nothing until this host writes SEEK. */
bool carrystep_seek_ended(const carrystep_session *session);

/* Queues a cut: the axes of `mask`, one bit each, drop all segments behind that in the slot
 * slots[axis], all of them in one tick or none. Segments that are queued behind it are executed
 * only if it is granted. False if there is no room for a write or if this host owns no session. */
bool carrystep_cut(carrystep_session *session, uint8_t mask, const uint8_t slots[CARRYSTEP_MOST_AXES]);

/* Whether the gateware has refused the last cut, because a segment that it names neither waits nor
 * runs any more. The cut and all writes behind it were removed; none was executed. */
bool carrystep_cut_refused(const carrystep_session *session);

/* The word of LATCH in a build with several latches: it arms the latches of `mask`, one bit each,
 * and chooses the latch whose record the LATCH_ registers show from now on. In a build with one
 * latch, any word arms it. */
#define CARRYSTEP_LATCH_WORD(mask, chosen) \
    (((uint32_t)(mask) & 15u) | ((uint32_t)(chosen) & 3u) << 4)

/* Removes the writes that were never sent, so that the next one is sent at once. */
void carrystep_withdraw(carrystep_session *session);

/* Encodes the next request to `line` (CARRYSTEP_LINE_BYTES). Returns the number of bytes, 0 if
 * there is nothing to send at the time `now`, ms. */
size_t carrystep_transmit(carrystep_session *session, uint32_t now, uint8_t *line);

/* Processes a byte received at the time `now`, ms. */
carrystep_event carrystep_receive(carrystep_session *session, uint8_t byte, uint32_t now, carrystep_answer *answer);

#ifdef __cplusplus
}
#endif

#endif

/* See carrystep_session.h. */
#include "carrystep_session.h"

#include <string.h>

#define WRITES(register) (CARRYSTEP_WRITE | (register))
#define SINGLES (CARRYSTEP_MOST_AXES + 2u)

typedef char carrystep_slots_are_1_to_127[CARRYSTEP_SLOTS >= 1 && CARRYSTEP_SLOTS <= CARRYSTEP_WINDOW ? 1 : -1];

carrystep_verdict carrystep_check(uint32_t identity, uint32_t protocol, uint64_t build, uint64_t wanted)
{
    if (identity != CARRYSTEP_IDENTITY_VALUE) {
        return CARRYSTEP_OTHER_DEVICE;
    }
    if (protocol != CARRYSTEP_PROTOCOL_VERSION) {
        return CARRYSTEP_OTHER_PROTOCOL;
    }
    return build == wanted ? CARRYSTEP_FINE : CARRYSTEP_OTHER_BUILD;
}

void carrystep_begin(carrystep_session *session, uint32_t resend, uint32_t pause)
{
    memset(session, 0, sizeof *session);
    session->resend = resend;
    session->pause = pause;
    session->limit = CARRYSTEP_SLOTS;
}

void carrystep_limit(carrystep_session *session, uint8_t writes)
{
    session->limit = writes;
}

/* Owns the session with this number from now on; none if it is 0. */
static void own(carrystep_session *session, uint16_t number)
{
    session->number = number;
    session->first = 0;
    session->length = 0;
    session->sent = 0;
    session->reached = 0;
    session->has_refused = false;
    session->busy = false;
    session->starting = false;
    session->powering = false;
    session->seek_ended = false;
    session->cut_refused = false;
    session->keeps_refused_cut = false;
    memset(session->under_way, 0, sizeof session->under_way);
    memset(session->room, 0, sizeof session->room);
}

bool carrystep_opening(const carrystep_session *session)
{
    return session->opening != 0;
}

bool carrystep_owns(const carrystep_session *session)
{
    return session->number != 0;
}

/* ---- writes ---- */

static uint8_t slot(const carrystep_session *session, uint8_t index)
{
    unsigned place = (unsigned)session->at + index;
    return (uint8_t)(place < CARRYSTEP_SLOTS ? place : place - CARRYSTEP_SLOTS);
}

/* Updates the counts when a write is acknowledged or withdrawn. */
static void settle(carrystep_session *session, const carrystep_request *request)
{
    if (carrystep_is_segment(request->address)) {
        session->under_way[carrystep_axis_of(request->address)]--;
    } else if (request->address == WRITES(CARRYSTEP_START)) {
        session->starting = false;
    }
}

bool carrystep_may_start(const carrystep_session *session)
{
    return session->powering || !session->unpowered;
}

static bool push(carrystep_session *session, const carrystep_request *request)
{
    if (session->number == 0 || session->length == CARRYSTEP_SLOTS) {
        return false;
    }
    if (request->address == WRITES(CARRYSTEP_START) && !carrystep_may_start(session)) {
        return false;
    }
    session->slots[slot(session, session->length)] = *request;
    session->length++;
    if (carrystep_is_segment(request->address)) {
        uint8_t axis = carrystep_axis_of(request->address);
        session->under_way[axis]++;
        if (session->room[axis] > 0) {
            session->room[axis]--;
        }
    } else if (request->address == WRITES(CARRYSTEP_START)) {
        session->starting = true;
    } else if (request->address == WRITES(CARRYSTEP_SEEK)) {
        session->seek_ended = false;
    } else if (request->address == WRITES(CARRYSTEP_CUT)) {
        session->cut_refused = false;
    } else if (request->address == WRITES(CARRYSTEP_CONTROL)) {
        session->powering = (request->word & CARRYSTEP_CONTROL_ENABLE) != 0;
    }
    return true;
}

bool carrystep_write(carrystep_session *session, uint8_t address, uint32_t word)
{
    carrystep_request request;
    memset(&request, 0, sizeof request);
    request.writes = true;
    request.address = (uint8_t)WRITES(address);
    request.word = word;
    return push(session, &request);
}

bool carrystep_put(carrystep_session *session, uint8_t axis, const carrystep_segment *segment)
{
    carrystep_request request;
    if (axis >= session->axes || segment->ticks == 0) {
        return false;
    }
    memset(&request, 0, sizeof request);
    request.writes = true;
    request.address = (uint8_t)WRITES(CARRYSTEP_OF_AXIS(CARRYSTEP_SEGMENT, axis));
    request.segment = *segment;
    return push(session, &request);
}

bool carrystep_cut(carrystep_session *session, uint8_t mask, const uint8_t slots[CARRYSTEP_MOST_AXES])
{
    carrystep_request request;
    uint8_t next = (uint8_t)(session->first + session->length);
    /* A copy of a refused cut may have been refused as well, and the answer would be taken for that
     * of this one. So a write that changes nothing takes the number. */
    if (session->keeps_refused_cut && session->refused_cut == next &&
        !carrystep_write(session, CARRYSTEP_IDENTITY, 0)) {
        return false;
    }
    memset(&request, 0, sizeof request);
    request.writes = true;
    request.address = (uint8_t)WRITES(CARRYSTEP_CUT);
    request.mask = mask;
    memcpy(request.slots, slots, sizeof request.slots);
    return push(session, &request);
}

bool carrystep_cut_refused(const carrystep_session *session)
{
    return session->cut_refused;
}

void carrystep_withdraw(carrystep_session *session)
{
    while (session->length > session->reached) {
        session->length--;
        settle(session, &session->slots[slot(session, session->length)]);
    }
}

bool carrystep_seek_ended(const carrystep_session *session)
{
    return session->seek_ended;
}

static size_t send_write(carrystep_session *session, uint32_t now, uint8_t *line)
{
    uint32_t waited = now - session->since;
    uint8_t sequence;
    if (session->sent > 0 && session->length > 0 && waited >= session->resend) {
        session->sent = 0;
        session->has_refused = false;
    }
    if (session->sent >= session->length || session->sent >= session->limit ||
        (session->busy && waited < session->pause)) {
        return 0;
    }
    if (session->sent == 0) {
        session->since = now;
    }
    session->busy = false;
    sequence = (uint8_t)(session->first + session->sent);
    session->sent++;
    if (session->reached < session->sent) {
        session->reached = session->sent;
    }
    return carrystep_encode(line, sequence, session->number,
                            &session->slots[slot(session, (uint8_t)(session->sent - 1u))]);
}

/* Processes a refusal. The gateware refuses every write behind a missing one, so one loss causes
 * many refusals with rising numbers. Only the first of them begins a new round. */
static void refusal(carrystep_session *session, uint8_t behind, bool busy, uint32_t now)
{
    if (!session->has_refused || behind <= session->refused) {
        session->sent = 0;
        session->busy = busy;
        session->since = now;
    }
    session->has_refused = true;
    session->refused = behind;
}

/* Whether this answers an unacknowledged write. */
static bool answers(const carrystep_session *session, const carrystep_answer *answer)
{
    uint8_t behind = (uint8_t)(answer->sequence - session->first);
    return answer->written && behind < session->reached &&
           session->slots[slot(session, behind)].address == answer->address;
}

/* Processes the acknowledgement in an answer: all writes before `next` were executed. An answer
 * whose `next` this host cannot have caused is from a time before this session, and is ignored. */
static void count(carrystep_session *session, const carrystep_answer *answer, uint32_t now)
{
    uint8_t advance = (uint8_t)(answer->next - session->first);
    bool busy = answer->reason == CARRYSTEP_REASON_BUSY;
    bool refused = (busy || answer->reason == CARRYSTEP_REASON_SEQUENCE) && answers(session, answer);
    bool ended = answers(session, answer);
    bool ends_seek = answer->reason == CARRYSTEP_REASON_SEEK_ENDED && ended;
    bool refuses_cut = answer->reason == CARRYSTEP_REASON_CUT && ended;
    if (advance > session->reached) {
        return;
    }
    for (uint8_t done = 0; done < advance; done++) {
        settle(session, &session->slots[session->at]);
        session->at = slot(session, 1);
    }
    session->first = answer->next;
    session->length = (uint8_t)(session->length - advance);
    session->reached = (uint8_t)(session->reached - advance);
    session->sent = (uint8_t)(session->sent > advance ? session->sent - advance : 0);
    if (advance > 0) {
        session->since = now;
        session->has_refused = false;
        session->busy = false;
        session->keeps_refused_cut = false;
    }
    if (ends_seek || refuses_cut) {
        /* The gateware has executed none of these writes, and the next one has the number of the
         * first of them. */
        session->reached = 0;
        session->sent = 0;
        session->has_refused = false;
        carrystep_withdraw(session);
        session->seek_ended = session->seek_ended || ends_seek;
        session->cut_refused = refuses_cut;
        if (refuses_cut) {
            session->keeps_refused_cut = true;
            session->refused_cut = answer->next;
        }
    }
    if (refused) {
        refusal(session, (uint8_t)(answer->sequence - answer->next), busy, now);
    }
    if (carrystep_names_axis(answer)) {
        uint8_t axis = carrystep_axis_of(answer->address);
        uint8_t under_way = session->under_way[axis];
        uint8_t room = (uint8_t)(answer->free > under_way ? answer->free - under_way : 0);
        /* Room only grows until this host sends a segment. */
        session->room[axis] = room > session->room[axis] ? room : session->room[axis];
    }
}

/* ---- requests outside of the sequence: reads, OPEN and STOP ---- */

static bool same(const carrystep_session *session, unsigned index, bool writes, uint8_t address)
{
    return session->singles[index].open && session->singles[index].request.writes == writes &&
           session->singles[index].request.address == address;
}

static void add(carrystep_session *session, bool writes, uint8_t address)
{
    for (unsigned index = 0; index < SINGLES; index++) {
        if (!session->singles[index].open) {
            memset(&session->singles[index], 0, sizeof session->singles[index]);
            session->singles[index].request.writes = writes;
            session->singles[index].request.address = address;
            session->singles[index].sequence = session->single_sequence++;
            session->singles[index].open = true;
            return;
        }
    }
}

static bool writing(const carrystep_session *session, uint8_t address)
{
    bool found = false;
    for (unsigned index = 0; index < SINGLES; index++) {
        found = found || same(session, index, true, address);
    }
    return found;
}

static void withdraw(carrystep_session *session, uint8_t address)
{
    for (unsigned index = 0; index < SINGLES; index++) {
        if (same(session, index, true, address)) {
            session->singles[index].open = false;
        }
    }
}

bool carrystep_read(carrystep_session *session, uint8_t address)
{
    unsigned reads = 0;
    for (unsigned index = 0; index < SINGLES; index++) {
        if (same(session, index, false, address)) {
            return true;
        }
        reads += session->singles[index].open && !session->singles[index].request.writes ? 1u : 0u;
    }
    if (reads == CARRYSTEP_MOST_AXES) {
        return false;
    }
    add(session, false, address);
    return true;
}

/* Forgets the session with its writes, and an OPEN without an answer. */
static void leave(carrystep_session *session)
{
    withdraw(session, WRITES(CARRYSTEP_OPEN));
    session->opening = 0;
    own(session, 0);
}

void carrystep_open(carrystep_session *session, uint16_t number, uint8_t axes)
{
    leave(session);
    session->opening = number;
    session->axes = axes < CARRYSTEP_MOST_AXES ? axes : (uint8_t)CARRYSTEP_MOST_AXES;
    add(session, true, WRITES(CARRYSTEP_OPEN));
}

void carrystep_stop(carrystep_session *session)
{
    carrystep_withdraw(session);
    withdraw(session, WRITES(CARRYSTEP_STOP));
    add(session, true, WRITES(CARRYSTEP_STOP));
}

bool carrystep_stopping(const carrystep_session *session)
{
    return writing(session, WRITES(CARRYSTEP_STOP));
}

/* Sends the next of these requests; writes come first. */
static size_t send_single(carrystep_session *session, uint32_t now, uint8_t *line)
{
    unsigned found = SINGLES;
    for (unsigned index = 0; index < SINGLES; index++) {
        bool due = session->singles[index].open &&
                   (!session->singles[index].asked || session->singles[index].overtaken ||
                    now - session->singles[index].when >= session->resend);
        bool before = found == SINGLES ||
                      (session->singles[index].request.writes && !session->singles[found].request.writes);
        if (due && before) {
            found = index;
        }
    }
    if (found == SINGLES) {
        return 0;
    }
    session->singles[found].sent_again =
        session->singles[found].asked && now - session->singles[found].when < session->resend;
    session->singles[found].overtaken = false;
    session->singles[found].asked = true;
    session->singles[found].when = now;
    session->singles[found].order = ++session->single_order;
    session->singles[found].before = (uint8_t)(session->first + session->sent);
    return carrystep_encode(line, session->singles[found].sequence,
                            same(session, found, true, WRITES(CARRYSTEP_OPEN)) ? session->opening : session->number,
                            &session->singles[found].request);
}

/* A request was answered: `order` is its place among these requests or, of a write, its sequence
 * number. Answers come in the order of requests, so those of these requests that were sent before it
 * were lost. They are sent again, once until their time is over. */
static void overtake(carrystep_session *session, bool is_write, uint8_t order)
{
    for (unsigned index = 0; index < SINGLES; index++) {
        uint8_t own = is_write ? session->singles[index].before : session->singles[index].order;
        if ((uint8_t)(order - own) < 0x80u && !session->singles[index].sent_again) {
            session->singles[index].overtaken = true;
        }
    }
}

/* Whether this answers one of these requests, which it completes. */
static bool answered(carrystep_session *session, const carrystep_answer *answer)
{
    for (unsigned index = 0; index < SINGLES; index++) {
        if (same(session, index, answer->written, answer->address) && session->singles[index].asked &&
            session->singles[index].sequence == answer->sequence) {
            session->singles[index].open = false;
            overtake(session, false, session->singles[index].order);
            return true;
        }
    }
    if (answer->written) {
        overtake(session, true, answer->sequence);
    }
    return false;
}

bool carrystep_writing(const carrystep_session *session)
{
    return session->length > 0;
}

bool carrystep_waiting(const carrystep_session *session)
{
    for (unsigned index = 0; index < SINGLES; index++) {
        if (session->singles[index].open) {
            return true;
        }
    }
    return session->length > 0;
}

/* ---- the line ---- */

size_t carrystep_transmit(carrystep_session *session, uint32_t now, uint8_t *line)
{
    size_t length = send_single(session, now, line);
    return length > 0 ? length : send_write(session, now, line);
}

carrystep_event carrystep_receive(carrystep_session *session, uint8_t byte, uint32_t now, carrystep_answer *answer)
{
    switch (carrystep_decode(&session->decoder, byte, answer)) {
    case CARRYSTEP_NOTHING:
        return CARRYSTEP_QUIET;
    case CARRYSTEP_BROKEN:
        return CARRYSTEP_DAMAGED;
    case CARRYSTEP_ANSWERED:
        break;
    }
    session->unpowered = !answer->ready && !answer->fault;
    session->armed = answer->armed;
    bool single = answered(session, answer);
    if (answer->written && answer->address == WRITES(CARRYSTEP_OPEN)) {
        if (single) {
            own(session, answer->reason == 0 ? session->opening : 0);
            session->opening = 0;
        }
    } else if (answer->reason != CARRYSTEP_REASON_SESSION) {
        count(session, answer, now);
    } else if (session->number != 0) {
        leave(session);
        return CARRYSTEP_LOST;
    }
    return CARRYSTEP_HEARD;
}

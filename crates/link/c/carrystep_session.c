/* See carrystep_session.h. */
#include "carrystep_session.h"

#include <string.h>

#define WRITES(register) (CARRYSTEP_WRITE | (register))

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
}

void carrystep_adopt(carrystep_session *session, uint8_t next, uint8_t axes)
{
    session->first = next;
    session->length = 0;
    session->sent = 0;
    session->reached = 0;
    session->has_refused = false;
    session->busy = false;
    session->starting = false;
    session->powering = false;
    session->axes = axes < CARRYSTEP_MOST_AXES ? axes : (uint8_t)CARRYSTEP_MOST_AXES;
    memset(session->under_way, 0, sizeof session->under_way);
    memset(session->room, 0, sizeof session->room);
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
    if (session->axes == 0 || session->length == CARRYSTEP_SLOTS) {
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

void carrystep_withdraw(carrystep_session *session)
{
    while (session->length > session->reached) {
        session->length--;
        settle(session, &session->slots[slot(session, session->length)]);
    }
}

static size_t send_write(carrystep_session *session, uint32_t now, uint8_t *line)
{
    uint32_t waited = now - session->since;
    uint8_t sequence;
    if (session->sent > 0 && session->length > 0 && waited >= session->resend) {
        session->sent = 0;
        session->has_refused = false;
    }
    if (session->sent >= session->length || (session->busy && waited < session->pause)) {
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
    return carrystep_encode(line, sequence, &session->slots[slot(session, (uint8_t)(session->sent - 1u))]);
}

/* Processes a refusal. The gateware refuses every write behind a missing one, so one loss causes
 * many refusals with rising numbers. Only the first of them begins a new round. */
static void refusal(carrystep_session *session, uint8_t behind, uint32_t now)
{
    if (!session->has_refused || behind <= session->refused) {
        session->sent = 0;
        session->busy = behind == 0;
        session->since = now;
    }
    session->has_refused = true;
    session->refused = behind;
}

/* Whether this answers a write of this host, as far as that can be known. Of acknowledged writes
 * only the number is left, so a late answer to one of them is accepted. */
static bool own(const carrystep_session *session, const carrystep_answer *answer)
{
    uint8_t behind = (uint8_t)(answer->sequence - session->first);
    if (!answer->written || behind > CARRYSTEP_WINDOW) {
        return true;
    }
    return behind < session->reached && session->slots[slot(session, behind)].address == answer->address;
}

/* Processes the acknowledgement in an answer: all writes before `next` were executed. */
static bool count(carrystep_session *session, const carrystep_answer *answer, uint32_t now)
{
    uint8_t advance = (uint8_t)(answer->next - session->first);
    if (!own(session, answer) || advance > session->reached) {
        return false;
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
    }
    if (answer->refused && session->length > 0) {
        refusal(session, (uint8_t)(answer->sequence - answer->next), now);
    }
    return true;
}

/* ---- reads ---- */

bool carrystep_read(carrystep_session *session, uint8_t address)
{
    int place = -1;
    for (int index = 0; index < (int)CARRYSTEP_MOST_AXES; index++) {
        if (session->reads[index].open && session->reads[index].address == address) {
            return true;
        }
        if (!session->reads[index].open && place < 0) {
            place = index;
        }
    }
    if (place < 0) {
        return false;
    }
    session->reads[place].address = address;
    session->reads[place].sequence = session->read_sequence++;
    session->reads[place].open = true;
    session->reads[place].asked = false;
    return true;
}

static size_t send_read(carrystep_session *session, uint32_t now, uint8_t *line)
{
    for (int index = 0; index < (int)CARRYSTEP_MOST_AXES; index++) {
        if (session->reads[index].open &&
            (!session->reads[index].asked || now - session->reads[index].when >= session->resend)) {
            carrystep_request request;
            memset(&request, 0, sizeof request);
            request.address = session->reads[index].address;
            session->reads[index].asked = true;
            session->reads[index].when = now;
            return carrystep_encode(line, session->reads[index].sequence, &request);
        }
    }
    return 0;
}

static void answered(carrystep_session *session, const carrystep_answer *answer)
{
    for (int index = 0; index < (int)CARRYSTEP_MOST_AXES; index++) {
        if (!answer->written && session->reads[index].open && session->reads[index].asked &&
            session->reads[index].address == answer->address && session->reads[index].sequence == answer->sequence) {
            session->reads[index].open = false;
            return;
        }
    }
}

bool carrystep_writing(const carrystep_session *session)
{
    return session->length > 0;
}

bool carrystep_waiting(const carrystep_session *session)
{
    for (int index = 0; index < (int)CARRYSTEP_MOST_AXES; index++) {
        if (session->reads[index].open) {
            return true;
        }
    }
    return session->length > 0;
}

/* ---- the line ---- */

size_t carrystep_transmit(carrystep_session *session, uint32_t now, uint8_t *line)
{
    size_t length = send_read(session, now, line);
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
    if (session->axes > 0) {
        if (!count(session, answer, now)) {
            return CARRYSTEP_OUT_OF_STEP;
        }
        session->armed = answer->armed;
        if (carrystep_names_axis(answer)) {
            uint8_t axis = carrystep_axis_of(answer->address);
            uint8_t under_way = session->under_way[axis];
            session->room[axis] = (uint8_t)(answer->free > under_way ? answer->free - under_way : 0);
        }
    }
    session->unpowered = !answer->ready && !answer->fault;
    answered(session, answer);
    return CARRYSTEP_HEARD;
}

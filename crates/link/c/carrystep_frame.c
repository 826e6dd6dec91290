/* See carrystep_frame.h. */
#include "carrystep_frame.h"

uint32_t carrystep_crc(const uint8_t *bytes, size_t length)
{
    uint32_t crc = UINT32_MAX;
    for (size_t at = 0; at < length; at++) {
        crc ^= bytes[at];
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc & 1u) != 0 ? crc >> 1 ^ CARRYSTEP_CRC_POLYNOMIAL : crc >> 1;
        }
    }
    return crc ^ UINT32_MAX;
}

bool carrystep_is_segment(uint8_t address)
{
    return address >= (CARRYSTEP_WRITE | CARRYSTEP_SEGMENT) && address < (CARRYSTEP_WRITE | CARRYSTEP_SEGMENTS);
}

bool carrystep_names_axis(const carrystep_answer *answer)
{
    return answer->written ? carrystep_is_segment(answer->address) : answer->address >= CARRYSTEP_AXES_AT;
}

uint8_t carrystep_axis_of(uint8_t address)
{
    return (uint8_t)(address & (CARRYSTEP_MOST_AXES - 1u));
}

static size_t put_word(uint8_t *frame, size_t at, uint32_t word)
{
    for (int byte = 0; byte < 4; byte++) {
        frame[at++] = (uint8_t)(word >> 8 * byte & 0xffu);
    }
    return at;
}

static size_t put_long(uint8_t *frame, size_t at, int64_t value)
{
    at = put_word(frame, at, (uint32_t)((uint64_t)value & UINT32_MAX));
    return put_word(frame, at, (uint32_t)((uint64_t)value >> 32));
}

static uint32_t word_at(const uint8_t *frame, size_t at)
{
    return (uint32_t)frame[at] | (uint32_t)frame[at + 1] << 8 | (uint32_t)frame[at + 2] << 16 |
           (uint32_t)frame[at + 3] << 24;
}

size_t carrystep_encode(uint8_t *line, uint8_t sequence, uint16_t session, const carrystep_request *request)
{
    uint8_t frame[CARRYSTEP_LONGEST_REQUEST] = {sequence, request->address};
    size_t length = CARRYSTEP_REQUEST_HEAD;
    size_t out = 0;
    if (request->writes || session != 0) {
        frame[length++] = (uint8_t)(session & 0xffu);
        frame[length++] = (uint8_t)(session >> 8);
    }
    if (request->writes && carrystep_is_segment(request->address)) {
        const carrystep_segment *segment = &request->segment;
        length = put_word(frame, length, segment->ticks - 1u);
        length = put_long(frame, length, segment->v);
        length = put_long(frame, length, segment->a);
        length = put_long(frame, length, segment->j);
        length = put_word(frame, length, (segment->last ? 1u : 0u) | segment->outputs);
    } else if (request->writes && request->address == (CARRYSTEP_WRITE | CARRYSTEP_CUT)) {
        for (uint8_t axis = 0; axis < CARRYSTEP_MOST_AXES; axis++) {
            bool named = (request->mask >> axis & 1u) != 0;
            length = put_word(frame, length, named ? 1u << 24 | (request->slots[axis] & 0x1fu) : 0u);
        }
    } else if (request->writes) {
        length = put_word(frame, length, request->word);
    }
    length = put_word(frame, length, carrystep_crc(frame, length));
    line[out++] = CARRYSTEP_END;
    for (size_t at = 0; at < length; at++) {
        if (frame[at] == CARRYSTEP_END) {
            line[out++] = CARRYSTEP_ESC;
            line[out++] = CARRYSTEP_ESC_END;
        } else if (frame[at] == CARRYSTEP_ESC) {
            line[out++] = CARRYSTEP_ESC;
            line[out++] = CARRYSTEP_ESC_ESC;
        } else {
            line[out++] = frame[at];
        }
    }
    line[out++] = CARRYSTEP_END;
    return out;
}

/* Decodes an answer from a complete frame. */
static bool take(const uint8_t *frame, uint8_t length, carrystep_answer *answer)
{
    const size_t content = CARRYSTEP_ANSWER_BYTES - CARRYSTEP_CRC_BYTES;
    if (length != CARRYSTEP_ANSWER_BYTES || carrystep_crc(frame, content) != word_at(frame, content)) {
        return false;
    }
    answer->sequence = CARRYSTEP_ANSWER_SEQUENCE(frame);
    answer->address = CARRYSTEP_ANSWER_ADDRESS(frame);
    answer->next = CARRYSTEP_ANSWER_NEXT(frame);
    answer->fault = CARRYSTEP_ANSWER_FAULT(frame) != 0;
    answer->cut_refused = CARRYSTEP_ANSWER_CUT_REFUSED(frame) != 0;
    answer->halted = CARRYSTEP_ANSWER_HALTED(frame) != 0;
    answer->idle = CARRYSTEP_ANSWER_IDLE(frame) != 0;
    answer->ready = CARRYSTEP_ANSWER_READY(frame) != 0;
    answer->armed = CARRYSTEP_ANSWER_ARMED(frame) != 0;
    answer->cause = CARRYSTEP_ANSWER_CAUSE(frame);
    answer->free = CARRYSTEP_ANSWER_FREE(frame);
    answer->reason = CARRYSTEP_ANSWER_REASON(frame);
    answer->written = CARRYSTEP_ANSWER_WRITTEN(frame) != 0;
    answer->culprits = CARRYSTEP_ANSWER_CULPRITS(frame);
    answer->seeking = CARRYSTEP_ANSWER_SEEKING(frame);
    answer->data = word_at(frame, CARRYSTEP_ANSWER_DATA);
    return true;
}

carrystep_received carrystep_decode(carrystep_decoder *decoder, uint8_t byte, carrystep_answer *answer)
{
    if (byte == CARRYSTEP_END) {
        uint8_t length = decoder->length;
        bool broken = decoder->broken || decoder->escaped;
        decoder->length = 0;
        decoder->escaped = false;
        decoder->broken = false;
        if (length == 0 && !broken) {
            return CARRYSTEP_NOTHING;
        }
        return !broken && take(decoder->bytes, length, answer) ? CARRYSTEP_ANSWERED : CARRYSTEP_BROKEN;
    }
    if (!decoder->escaped && byte == CARRYSTEP_ESC) {
        decoder->escaped = true;
        return CARRYSTEP_NOTHING;
    }
    if (decoder->escaped) {
        decoder->escaped = false;
        if (byte == CARRYSTEP_ESC_END) {
            byte = CARRYSTEP_END;
        } else if (byte == CARRYSTEP_ESC_ESC) {
            byte = CARRYSTEP_ESC;
        } else {
            decoder->broken = true;
        }
    }
    if (decoder->length < CARRYSTEP_ANSWER_BYTES) {
        decoder->bytes[decoder->length++] = byte;
    } else {
        decoder->broken = true;
    }
    return CARRYSTEP_NOTHING;
}

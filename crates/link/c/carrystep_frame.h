/* Requests to the gateware and its answers, as bytes on the line (docs/protocol.md).
 *
 * C99, without allocation, floating point and division. */
#ifndef CARRYSTEP_FRAME_H
#define CARRYSTEP_FRAME_H

#include "carrystep_registers.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Greatest number of bytes of a request on the line, with END and ESC. */
#define CARRYSTEP_LINE_BYTES (2u * CARRYSTEP_LONGEST_REQUEST + 2u)

/* A run of whole ticks during which one axis follows a cubic. */
typedef struct {
    uint32_t ticks; /* 1 or more */
    int64_t v;      /* 2^-64 step per tick */
    int64_t a;      /* 2^-64 step per tick^2 */
    int64_t j;      /* 2^-64 step per tick^3 */
    bool last;      /* the axis stops when it is over */
    /* What changes at the outputs where it begins: CARRYSTEP_OUTPUTS and CARRYSTEP_DUTY, or both
     * joined by |, or 0 for nothing. Only segments of axis 0 change outputs. */
    uint32_t outputs;
} carrystep_segment;

/* The outputs of `mask`, one bit each, get these levels; 1 is active. */
#define CARRYSTEP_OUTPUTS(mask, levels) ((uint32_t)((mask) & 0xffu) << 4 | (uint32_t)((levels) & 0xffu) << 12)

/* The PWM gets this duty, 0 to 4095 of 4096. */
#define CARRYSTEP_DUTY(duty) (1u << 1 | (uint32_t)((duty) & 0xfffu) << 20)

/* A request: a read, a write of one word (address CARRYSTEP_WRITE | register), a segment
 * (address CARRYSTEP_WRITE | CARRYSTEP_OF_AXIS(CARRYSTEP_SEGMENT, axis)), or a cut (address
 * CARRYSTEP_WRITE | CARRYSTEP_CUT). */
typedef struct {
    bool writes;
    uint8_t address;
    uint32_t word;             /* of a write */
    carrystep_segment segment; /* of a segment */
    /* of a cut: the axes that take part, one bit each, and the slot that each of them keeps */
    uint8_t mask;
    uint8_t slots[CARRYSTEP_MOST_AXES];
} carrystep_request;

/* The gateware's answer to a request; carrystep_registers.h gives the meaning of the fields. `reason`
 * is 0, or the CARRYSTEP_REASON_ for which the request was not executed. */
typedef struct {
    uint8_t sequence;
    uint8_t address;
    uint8_t next;
    bool fault;
    bool cut_refused; /* the last cut was refused */
    bool halted;
    bool idle;
    bool ready;
    bool armed;
    uint8_t cause;
    uint8_t free;
    uint8_t reason;
    bool written; /* the request was a write */
    uint8_t culprits;
    uint8_t seeking;
    uint32_t data;
} carrystep_answer;

/* Decodes answers from the line. A decoder of all zeros is in its initial state. */
typedef struct {
    uint8_t bytes[CARRYSTEP_ANSWER_BYTES];
    uint8_t length;
    bool escaped;
    bool broken;
} carrystep_decoder;

typedef enum {
    CARRYSTEP_NOTHING, /* no frame has ended */
    CARRYSTEP_ANSWERED,
    CARRYSTEP_BROKEN /* a damaged frame: nothing was taken from it */
} carrystep_received;

/* The CRC-32 of Ethernet, zip and zlib. */
uint32_t carrystep_crc(const uint8_t *bytes, size_t length);

/* Whether a write to this address is a segment. */
bool carrystep_is_segment(uint8_t address);

/* Whether `free` of an answer belongs to an axis that its address names: that of a register that was
 * read, or of a segment. */
bool carrystep_names_axis(const carrystep_answer *answer);

/* The axis that such an address names. */
uint8_t carrystep_axis_of(uint8_t address);

/* Encodes a request of this session to `line`, which has CARRYSTEP_LINE_BYTES bytes. A read of
 * session 0 is free: it belongs to no session. Returns the number of bytes used. */
size_t carrystep_encode(uint8_t *line, uint8_t sequence, uint16_t session, const carrystep_request *request);

/* Processes the next byte from the line. If it completes an answer, *answer is set. */
carrystep_received carrystep_decode(carrystep_decoder *decoder, uint8_t byte, carrystep_answer *answer);

#ifdef __cplusplus
}
#endif

#endif

/* Which board it is: the registers that never change. */
#ifndef CARRYSTEP_FACTS_H
#define CARRYSTEP_FACTS_H

#include "carrystep_session.h"

typedef struct {
    uint32_t identity, protocol, build_low, build_high, axes, tick_ns, depth;
    uint8_t known; /* number of these that have been read */
} carrystep_facts;

/* Takes an answer, or NULL, and asks for the next fact. True if all are known. */
bool carrystep_facts_ask(carrystep_facts *facts, carrystep_session *session, const carrystep_answer *answer);

/* Whether the component can drive this board with `axes` joints. `build`: the build id that is
 * required; 0: any. */
bool carrystep_facts_fit(const carrystep_facts *facts, uint8_t axes, uint64_t build);

#endif

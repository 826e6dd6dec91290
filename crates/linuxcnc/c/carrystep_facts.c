/* See carrystep_facts.h. */
#include "carrystep_facts.h"

static const uint8_t FACTS[] = {CARRYSTEP_IDENTITY,   CARRYSTEP_PROTOCOL, CARRYSTEP_BUILD_LOW,  CARRYSTEP_BUILD_HIGH,
                                CARRYSTEP_AXIS_COUNT, CARRYSTEP_TICK_NS,  CARRYSTEP_QUEUE_DEPTH};

bool carrystep_facts_ask(carrystep_facts *facts, carrystep_session *session, const carrystep_answer *answer)
{
    uint32_t *words[] = {&facts->identity, &facts->protocol, &facts->build_low, &facts->build_high,
                         &facts->axes,     &facts->tick_ns,  &facts->depth};
    if (facts->known < sizeof FACTS && answer != NULL && !answer->written && answer->address == FACTS[facts->known]) {
        *words[facts->known] = answer->data;
        facts->known++;
    }
    if (facts->known < sizeof FACTS) {
        carrystep_read(session, FACTS[facts->known]);
        return false;
    }
    return true;
}

bool carrystep_facts_fit(const carrystep_facts *facts, uint8_t axes, uint64_t build)
{
    uint64_t own = (uint64_t)facts->build_high << 32 | facts->build_low;
    return carrystep_check(facts->identity, facts->protocol, own, build != 0 ? build : own) == CARRYSTEP_FINE &&
           facts->axes >= axes && facts->axes <= CARRYSTEP_MOST_AXES && facts->tick_ns != 0 &&
           facts->depth >= CARRYSTEP_LEAST_QUEUE && facts->depth <= 31u;
}

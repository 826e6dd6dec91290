/* See carrystep_feeder.h. */
#include "carrystep_feeder.h"

#include <string.h>

void carrystep_load(carrystep_feeder *feeder, carrystep_source source)
{
    memset(feeder, 0, sizeof *feeder);
    feeder->source = source;
}

static void look_ahead(carrystep_feeder *feeder, uint8_t axes)
{
    carrystep_source *source = &feeder->source;
    for (uint8_t axis = 0; axis < axes; axis++) {
        if (!feeder->axes[axis].has && !feeder->axes[axis].dry) {
            feeder->axes[axis].has = source->segment(source->context, axis, &feeder->axes[axis].ahead);
            feeder->axes[axis].dry = !feeder->axes[axis].has;
        }
    }
    if (!feeder->has_start && !feeder->last_start) {
        feeder->has_start = source->start(source->context, &feeder->start);
        feeder->last_start = !feeder->has_start;
    }
}

/* The axis to supply next: of the axes with a segment and a free queue place, the one whose sent
 * segments last for the shortest time. -1 if there is none. */
static int hungriest(const carrystep_session *session, const carrystep_feeder *feeder)
{
    int found = -1;
    for (int axis = 0; axis < session->axes; axis++) {
        if (feeder->axes[axis].has && session->room[axis] > 0 &&
            (found < 0 || feeder->axes[axis].ticks < feeder->axes[found].ticks)) {
            found = axis;
        }
    }
    return found;
}

static bool hand_over(carrystep_session *session, carrystep_feeder *feeder, int axis)
{
    carrystep_segment segment = feeder->axes[axis].ahead;
    feeder->axes[axis].has = false;
    feeder->axes[axis].waiting += feeder->axes[axis].open ? 0u : 1u;
    feeder->axes[axis].open = !segment.last;
    feeder->axes[axis].ticks += segment.ticks;
    return carrystep_put(session, (uint8_t)axis, &segment);
}

typedef enum { NOT_YET, STARTED, WRONG, UNPOWERED } started;

/* Sends a start if each of its axes has the first segment of its move. */
static started start(carrystep_session *session, carrystep_feeder *feeder)
{
    for (int axis = 0; axis < (int)CARRYSTEP_MOST_AXES; axis++) {
        if ((feeder->start >> axis & 1) != 0) {
            if (axis >= session->axes) {
                return WRONG;
            }
            if (feeder->axes[axis].waiting == 0) {
                return feeder->axes[axis].dry ? WRONG : NOT_YET;
            }
        }
    }
    if (!carrystep_may_start(session)) {
        return UNPOWERED;
    }
    for (int axis = 0; axis < (int)CARRYSTEP_MOST_AXES; axis++) {
        feeder->axes[axis].waiting -= (uint32_t)(feeder->start >> axis & 1);
    }
    feeder->has_start = false;
    return carrystep_write(session, CARRYSTEP_START, feeder->start) ? STARTED : WRONG;
}

/* Reads the state of each axis without room, if no acknowledgement of a segment will report it. */
static void ask(carrystep_session *session, const carrystep_feeder *feeder)
{
    for (uint8_t axis = 0; axis < session->axes; axis++) {
        bool full = session->under_way[axis] == 0 && session->room[axis] == 0 && feeder->axes[axis].has;
        bool armed = axis == 0 && session->armed && feeder->has_start;
        if (full || armed) {
            carrystep_read(session, (uint8_t)CARRYSTEP_OF_AXIS(CARRYSTEP_POSITION, axis));
        }
    }
}

carrystep_fed carrystep_feed(carrystep_session *session, carrystep_feeder *feeder)
{
    look_ahead(feeder, session->axes);
    while (session->length < CARRYSTEP_SLOTS && !session->seek_ended) {
        int axis = hungriest(session, feeder);
        if (axis >= 0) {
            if (!hand_over(session, feeder, axis)) {
                return CARRYSTEP_BAD_SOURCE;
            }
        } else if (feeder->has_start && !session->starting && !session->armed) {
            started outcome = start(session, feeder);
            if (outcome == WRONG) {
                return CARRYSTEP_BAD_SOURCE;
            }
            if (outcome == UNPOWERED) {
                return CARRYSTEP_NO_POWER;
            }
            if (outcome == NOT_YET) {
                break;
            }
        } else {
            break;
        }
        look_ahead(feeder, session->axes);
    }
    ask(session, feeder);
    for (uint8_t axis = 0; axis < session->axes; axis++) {
        if (!feeder->axes[axis].dry) {
            return CARRYSTEP_FEEDING;
        }
    }
    return feeder->last_start && !feeder->has_start ? CARRYSTEP_FED : CARRYSTEP_FEEDING;
}

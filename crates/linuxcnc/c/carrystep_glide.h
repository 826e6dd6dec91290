/* The jump of a command at an index pulse, made good smoothly.
 *
 * When LinuxCNC sees that index-enable has fallen, it sets its command to the feedback of that
 * period, the place of the pulse (homing.c, HOME_SET_INDEX_POSITION). The axis is commanded to be
 * further on by then: by the horizon, and by the time that the report took. So the command jumps
 * back. The axis goes on with its speed instead, and returns within a second to the command. */
#ifndef CARRYSTEP_GLIDE_H
#define CARRYSTEP_GLIDE_H

#include <stdbool.h>
#include <stdint.h>

/* Of an axis. All zeros: no jump. */
typedef struct {
    bool shown;      /* the next command may jump */
    double place;    /* to this place, steps */
    double gap;      /* where the axis would be less the command, steps, in the period of the jump */
    double rest;     /* what is left of it in this period */
    uint32_t gone;   /* periods since */
} carrystep_glide;

/* The place of an index pulse, steps, is shown in this period. */
void carrystep_glide_show(carrystep_glide *glide, double place);

/* The command for the axis, steps, for a command of LinuxCNC's. `latest` and `previous` are the
 * last two commands for the axis, `most` is the greatest distance between two, all in steps. */
double carrystep_glide_take(carrystep_glide *glide, double command, double latest, double previous, double most,
                            uint32_t period_ns);

#endif

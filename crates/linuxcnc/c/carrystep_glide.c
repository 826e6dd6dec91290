/* See carrystep_glide.h. */
#include "carrystep_glide.h"

/* How long the axis takes to return to the command, ns. */
#define RETURN_NS 1000000000u

void carrystep_glide_show(carrystep_glide *glide, double place)
{
    glide->shown = true;
    glide->place = place;
}

double carrystep_glide_take(carrystep_glide *glide, double command, double latest, double previous, double most,
                            uint32_t period_ns)
{
    uint32_t periods = RETURN_NS / period_ns;
    double off = command - glide->place;
    if (glide->shown && off <= most && -off <= most) {
        glide->gap = latest + (latest - previous) - command;
        glide->gone = 0;
    }
    glide->shown = false;
    if (glide->gone >= periods) {
        glide->gap = 0.0;
    }
    double part = periods > 0 ? (double)glide->gone / (double)periods : 1.0;
    glide->rest = glide->gap * (1.0 - part * part * (3.0 - 2.0 * part));
    glide->gone += glide->gone < periods ? 1u : 0u;
    return command + glide->rest;
}

/* The thread that owns the line to the board: opens the device, passes bytes between it and
 * carrystep_pump, and tries again when it has gone. POSIX, for Linux. */
#ifndef CARRYSTEP_PORT_H
#define CARRYSTEP_PORT_H

#include "carrystep_line.h"

#include <pthread.h>

typedef struct {
    carrystep_shared *shared;
    carrystep_pump_how how;
    const char *path; /* of the device; it must stay */
    carrystep_rates rates;
    pthread_t thread;
    const carrystep_line_kind *kind; /* of the device that is open */
    carrystep_pump pump;
} carrystep_port;

/* Opens a device for one program alone, and says which kind of line it is. Returns its descriptor,
 * or -1 with the fault in *fault: CARRYSTEP_FAULT_NO_PORT or CARRYSTEP_FAULT_PORT_BUSY. */
int carrystep_port_open(const char *path, const carrystep_rates *rates, const carrystep_line_kind **kind,
                        uint32_t *fault);

/* Starts the thread; shared, how, path and rates are set. Returns 0, or an error number. */
int carrystep_port_begin(carrystep_port *port);

/* Ends the thread: it stops the axes by ramps, waits at most 2 s until they rest, removes the
 * drivers' power and closes the device. */
void carrystep_port_end(carrystep_port *port);

#endif

/* The thread that owns the serial port: opens it, passes bytes between it and carrystep_pump, and
 * tries again when it has gone. POSIX, for Linux. */
#ifndef CARRYSTEP_PORT_H
#define CARRYSTEP_PORT_H

#include "carrystep_pump.h"

#include <pthread.h>

typedef struct {
    carrystep_shared *shared;
    carrystep_pump_how how;
    const char *path; /* of the port; it must stay */
    uint32_t baud;
    pthread_t thread;
    carrystep_pump pump;
} carrystep_port;

/* Opens a port for one program alone, in raw mode. Returns its descriptor, or -1 with the fault in
 * *fault: CARRYSTEP_FAULT_NO_PORT or CARRYSTEP_FAULT_PORT_BUSY. */
int carrystep_port_open(const char *path, uint32_t baud, uint32_t *fault);

/* Whether the port can be set to this rate. */
bool carrystep_port_has_rate(uint32_t baud);

/* Starts the thread; shared, how, path and baud are set. Returns 0, or an error number. */
int carrystep_port_begin(carrystep_port *port);

/* Ends the thread: it stops the axes by ramps, waits at most 2 s until they rest, removes the
 * drivers' power and closes the port. */
void carrystep_port_end(carrystep_port *port);

#endif

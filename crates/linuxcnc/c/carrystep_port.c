/* See carrystep_port.h. */
#include "carrystep_port.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

#define AGAIN_US UINT64_C(300000) /* between tries to open the device */
#define END_US UINT64_C(2000000)  /* for the axes to come to rest when the component ends */

/* Locks and prepares a device. Returns 0 or a fault. */
static uint32_t prepare(int port, const carrystep_rates *rates, const carrystep_line_kind **kind)
{
    static const carrystep_line_kind *const KINDS[] = {&carrystep_spi, &carrystep_uart};
    if (flock(port, LOCK_EX | LOCK_NB) != 0) {
        return errno == EWOULDBLOCK ? CARRYSTEP_FAULT_PORT_BUSY : CARRYSTEP_FAULT_NO_PORT;
    }
    for (size_t at = 0; at < sizeof KINDS / sizeof KINDS[0]; at++) {
        if (KINDS[at]->is(port)) {
            *kind = KINDS[at];
            return KINDS[at]->prepare(port, rates);
        }
    }
    return CARRYSTEP_FAULT_NO_PORT;
}

int carrystep_port_open(const char *path, const carrystep_rates *rates, const carrystep_line_kind **kind,
                        uint32_t *fault)
{
    int port = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (port < 0) {
        *fault = errno == EBUSY ? CARRYSTEP_FAULT_PORT_BUSY : CARRYSTEP_FAULT_NO_PORT;
        return -1;
    }
    *fault = prepare(port, rates, kind);
    if (*fault != 0) {
        close(port);
        return -1;
    }
    return port;
}

uint64_t carrystep_now_us(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (uint64_t)time.tv_sec * UINT64_C(1000000) + (uint64_t)time.tv_nsec / 1000u;
}

static bool ending(const carrystep_port *port)
{
    return __atomic_load_n(&port->shared->end, __ATOMIC_ACQUIRE) != 0;
}

/* Keeps the longest time between two rounds, for the pin thread-pause-ms. */
static void measure(carrystep_shared *shared, uint64_t *round)
{
    uint64_t now = carrystep_now_us();
    uint64_t pause = now - *round < UINT32_MAX ? now - *round : UINT32_MAX;
    if (pause > __atomic_load_n(&shared->pause_us, __ATOMIC_RELAXED)) {
        __atomic_store_n(&shared->pause_us, (uint32_t)pause, __ATOMIC_RELAXED);
    }
    *round = now;
}

/* One connection, until the board or the device has gone or the component ends. */
static void connect_board(carrystep_port *port, carrystep_line *line)
{
    carrystep_pump *pump = &port->pump;
    uint64_t end = 0, round = carrystep_now_us();
    carrystep_pump_how how = port->how;
    how.number = (uint16_t)(1u + (round ^ (uint64_t)getpid() * 40503u) % 65535u);
    how.window = port->kind->window;
    carrystep_pump_begin(pump, port->shared, &how, carrystep_now_us());
    while (pump->state != CARRYSTEP_PUMP_GONE) {
        bool there = port->kind->wait(line);
        measure(port->shared, &round);
        if (!there || !port->kind->exchange(line, pump)) {
            carrystep_pump_away(port->shared, CARRYSTEP_FAULT_NO_PORT);
            return;
        }
        if (ending(port)) {
            end = end == 0 ? carrystep_now_us() + END_US : end;
            bool rests = pump->state == CARRYSTEP_PUMP_IDLE && !carrystep_writing(&pump->session);
            if (rests || pump->state < CARRYSTEP_PUMP_STOPPING || carrystep_now_us() > end) {
                return;
            }
        }
    }
}

static void *run(void *context)
{
    carrystep_port *port = context;
    while (!ending(port)) {
        uint32_t fault;
        carrystep_line line;
        memset(&line, 0, sizeof line);
        line.port = carrystep_port_open(port->path, &port->rates, &port->kind, &fault);
        if (line.port < 0) {
            carrystep_pump_away(port->shared, fault);
        } else {
            connect_board(port, &line);
            close(line.port);
        }
        uint64_t again = carrystep_now_us() + AGAIN_US;
        while (!ending(port) && carrystep_now_us() < again) {
            struct timespec nap = {0, 10000000};
            nanosleep(&nap, NULL);
        }
    }
    return NULL;
}

int carrystep_port_begin(carrystep_port *port)
{
    return pthread_create(&port->thread, NULL, run, port);
}

void carrystep_port_end(carrystep_port *port)
{
    __atomic_store_n(&port->shared->wanted, 0u, __ATOMIC_RELEASE);
    __atomic_store_n(&port->shared->end, 1u, __ATOMIC_RELEASE);
    pthread_join(port->thread, NULL);
}

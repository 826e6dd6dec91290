/* See carrystep_port.h. */
#include "carrystep_port.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <string.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#define AGAIN_US UINT64_C(300000) /* between tries to open the port */
#define END_US UINT64_C(2000000)  /* for the axes to come to rest when the component ends */

static const struct {
    uint32_t baud;
    speed_t speed;
} RATES[] = {
    {115200, B115200},   {230400, B230400},   {460800, B460800},   {500000, B500000},
    {576000, B576000},   {921600, B921600},   {1000000, B1000000}, {1152000, B1152000},
    {1500000, B1500000}, {2000000, B2000000}, {2500000, B2500000}, {3000000, B3000000},
};

static bool rate(uint32_t baud, speed_t *speed)
{
    for (size_t at = 0; at < sizeof RATES / sizeof RATES[0]; at++) {
        if (RATES[at].baud == baud) {
            *speed = RATES[at].speed;
            return true;
        }
    }
    return false;
}

bool carrystep_port_has_rate(uint32_t baud)
{
    speed_t speed;
    return rate(baud, &speed);
}

int carrystep_port_open(const char *path, uint32_t baud, uint32_t *fault)
{
    struct termios settings;
    speed_t speed;
    int port = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    *fault = errno == EBUSY ? CARRYSTEP_FAULT_PORT_BUSY : CARRYSTEP_FAULT_NO_PORT;
    if (port < 0) {
        return -1;
    }
    if (flock(port, LOCK_EX | LOCK_NB) != 0 || ioctl(port, TIOCEXCL) != 0) {
        *fault = errno == EWOULDBLOCK || errno == EBUSY ? CARRYSTEP_FAULT_PORT_BUSY : CARRYSTEP_FAULT_NO_PORT;
        close(port);
        return -1;
    }
    if (!rate(baud, &speed) || tcgetattr(port, &settings) != 0) {
        *fault = CARRYSTEP_FAULT_NO_PORT;
        close(port);
        return -1;
    }
    settings.c_iflag = 0;
    settings.c_oflag = 0;
    settings.c_lflag = 0;
    settings.c_cflag = CS8 | CREAD | CLOCAL;
    settings.c_cc[VMIN] = 0;
    settings.c_cc[VTIME] = 0;
    if (cfsetispeed(&settings, speed) != 0 || cfsetospeed(&settings, speed) != 0 ||
        tcsetattr(port, TCSANOW, &settings) != 0) {
        *fault = CARRYSTEP_FAULT_NO_PORT;
        close(port);
        return -1;
    }
    tcflush(port, TCIOFLUSH);
    return port;
}

static uint64_t now_us(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (uint64_t)time.tv_sec * UINT64_C(1000000) + (uint64_t)time.tv_nsec / 1000u;
}

static bool ending(const carrystep_port *port)
{
    return __atomic_load_n(&port->shared->end, __ATOMIC_ACQUIRE) != 0;
}

/* Takes all bytes that have come. False if the port has gone. */
static bool receive(carrystep_pump *pump, int port)
{
    uint8_t bytes[512];
    for (;;) {
        ssize_t length = read(port, bytes, sizeof bytes);
        if (length <= 0) {
            return length == 0 || errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
        }
        uint64_t now = now_us();
        for (ssize_t at = 0; at < length; at++) {
            carrystep_pump_receive(pump, now, bytes[at]);
        }
    }
}

/* Sends what is due, as far as the port takes it. False if the port has gone. */
static bool transmit(carrystep_pump *pump, int port, uint8_t *line, size_t *length, size_t *sent)
{
    for (;;) {
        if (*sent == *length) {
            *sent = 0;
            *length = carrystep_pump_transmit(pump, now_us(), line);
            if (*length == 0) {
                return true;
            }
        }
        ssize_t written = write(port, line + *sent, *length - *sent);
        if (written < 0) {
            return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
        }
        *sent += (size_t)written;
    }
}

/* Keeps the longest time between two rounds, for the pin thread-pause-ms. */
static void measure(carrystep_shared *shared, uint64_t *round)
{
    uint64_t now = now_us();
    uint64_t pause = now - *round < UINT32_MAX ? now - *round : UINT32_MAX;
    if (pause > __atomic_load_n(&shared->pause_us, __ATOMIC_RELAXED)) {
        __atomic_store_n(&shared->pause_us, (uint32_t)pause, __ATOMIC_RELAXED);
    }
    *round = now;
}

/* One connection, until the board or the port has gone or the component ends. */
static void connect_board(carrystep_port *port, int line_port)
{
    carrystep_pump *pump = &port->pump;
    uint8_t line[CARRYSTEP_LINE_BYTES];
    size_t length = 0, sent = 0;
    uint64_t end = 0, round = now_us();
    carrystep_pump_how how = port->how;
    how.number = (uint16_t)(1u + (now_us() ^ (uint64_t)getpid() * 40503u) % 65535u);
    carrystep_pump_begin(pump, port->shared, &how, now_us());
    while (pump->state != CARRYSTEP_PUMP_GONE) {
        struct pollfd wait = {line_port, POLLIN, 0};
        if (sent < length) {
            wait.events |= POLLOUT;
        }
        poll(&wait, 1, 1);
        measure(port->shared, &round);
        bool there = (wait.revents & (POLLERR | POLLHUP | POLLNVAL)) == 0 && receive(pump, line_port);
        carrystep_pump_run(pump, now_us());
        if (!there || !transmit(pump, line_port, line, &length, &sent)) {
            carrystep_pump_away(port->shared, CARRYSTEP_FAULT_NO_PORT);
            return;
        }
        if (ending(port)) {
            end = end == 0 ? now_us() + END_US : end;
            bool rests = pump->state == CARRYSTEP_PUMP_IDLE && !carrystep_writing(&pump->session);
            if (rests || pump->state < CARRYSTEP_PUMP_STOPPING || now_us() > end) {
                return;
            }
        }
    }
}

static void *run(void *context)
{
    carrystep_port *port = context;
    while (!ending(port)) {
        uint32_t fault = CARRYSTEP_FAULT_NO_PORT;
        int line = carrystep_port_open(port->path, port->baud, &fault);
        if (line < 0) {
            carrystep_pump_away(port->shared, fault);
        } else {
            connect_board(port, line);
            close(line);
        }
        uint64_t again = now_us() + AGAIN_US;
        while (!ending(port) && now_us() < again) {
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

/* A serial port, in raw mode. See carrystep_line.h. */
#include "carrystep_line.h"

#include <errno.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

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

bool carrystep_uart_has_rate(uint32_t baud)
{
    speed_t speed;
    return rate(baud, &speed);
}

static bool is(int port)
{
    struct termios settings;
    return tcgetattr(port, &settings) == 0;
}

static uint32_t prepare(int port, const carrystep_rates *rates)
{
    struct termios settings;
    speed_t speed;
    if (ioctl(port, TIOCEXCL) != 0) {
        return errno == EBUSY ? CARRYSTEP_FAULT_PORT_BUSY : CARRYSTEP_FAULT_NO_PORT;
    }
    if (!rate(rates->baud, &speed) || tcgetattr(port, &settings) != 0) {
        return CARRYSTEP_FAULT_NO_PORT;
    }
    settings.c_iflag = 0;
    settings.c_oflag = 0;
    settings.c_lflag = 0;
    settings.c_cflag = CS8 | CREAD | CLOCAL;
    settings.c_cc[VMIN] = 0;
    settings.c_cc[VTIME] = 0;
    if (cfsetispeed(&settings, speed) != 0 || cfsetospeed(&settings, speed) != 0 ||
        tcsetattr(port, TCSANOW, &settings) != 0) {
        return CARRYSTEP_FAULT_NO_PORT;
    }
    tcflush(port, TCIOFLUSH);
    return 0;
}

static bool wait_for_bytes(carrystep_line *line)
{
    struct pollfd wait = {line->port, POLLIN, 0};
    if (line->sent < line->length) {
        wait.events |= POLLOUT;
    }
    poll(&wait, 1, 1);
    return (wait.revents & (POLLERR | POLLHUP | POLLNVAL)) == 0;
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
        uint64_t now = carrystep_now_us();
        for (ssize_t at = 0; at < length; at++) {
            carrystep_pump_receive(pump, now, bytes[at]);
        }
    }
}

/* Sends what is due, as far as the port takes it. False if the port has gone. */
static bool transmit(carrystep_line *line, carrystep_pump *pump)
{
    for (;;) {
        if (line->sent == line->length) {
            line->sent = 0;
            line->length = carrystep_pump_transmit(pump, carrystep_now_us(), line->bytes);
            if (line->length == 0) {
                return true;
            }
        }
        ssize_t written = write(line->port, line->bytes + line->sent, line->length - line->sent);
        if (written < 0) {
            return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
        }
        line->sent += (size_t)written;
    }
}

static bool exchange(carrystep_line *line, carrystep_pump *pump)
{
    if (!receive(pump, line->port)) {
        return false;
    }
    carrystep_pump_run(pump, carrystep_now_us());
    return transmit(line, pump);
}

const carrystep_line_kind carrystep_uart = {is, prepare, wait_for_bytes, exchange, 0};

/* An SPI by Linux' spidev, mode 0. See carrystep_line.h.
 *
 * A transfer moves bytes in both directions at once, and the board sends only while this computer
 * clocks: so a transfer that sends requests is followed by others that fetch the answers. END
 * stands where a side has nothing to say. Chip select rises between transfers, at any byte of a
 * frame. */
#include "carrystep_line.h"

#include <linux/spi/spidev.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>

/* Writes that may be unacknowledged: together with the reads, the board holds their bytes in any
 * case (docs/protocol.md). */
#define WINDOW 6u

/* Least number of bytes of a transfer: three answers. */
#define LEAST 64u

/* Greatest number of bytes of a transfer: room for all that can be due in most cases. The rest goes
 * with the next transfer. */
#define MOST (2u * CARRYSTEP_LINE_BYTES)

/* Greatest number of transfers in a round, so that a line with noise does not keep the thread. */
#define TRANSFERS 16u

/* Time between two rounds, ns. */
#define NAP 500000

static bool is(int port)
{
    uint8_t mode;
    return ioctl(port, SPI_IOC_RD_MODE, &mode) == 0;
}

static uint32_t prepare(int port, const carrystep_rates *rates)
{
    uint8_t mode = SPI_MODE_0, bits = 8;
    uint32_t hz = rates->sck_hz;
    bool done = ioctl(port, SPI_IOC_WR_MODE, &mode) == 0 && ioctl(port, SPI_IOC_WR_BITS_PER_WORD, &bits) == 0 &&
                ioctl(port, SPI_IOC_WR_MAX_SPEED_HZ, &hz) == 0;
    return done ? 0 : (uint32_t)CARRYSTEP_FAULT_NO_PORT;
}

static bool nap(carrystep_line *line)
{
    struct timespec time = {0, NAP};
    (void)line;
    nanosleep(&time, NULL);
    return true;
}

/* The bytes of the next transfer; `requests` of them are requests. 0: none is needed. */
static size_t compose(carrystep_pump *pump, uint8_t *bytes, size_t *requests)
{
    size_t length = 0, added;
    do {
        added = carrystep_pump_transmit(pump, carrystep_now_us(), bytes + length);
        length += added;
    } while (added > 0 && MOST - length >= CARRYSTEP_LINE_BYTES);
    *requests = length;
    if (length == 0 && (pump->state == CARRYSTEP_PUMP_GONE || !carrystep_waiting(&pump->session))) {
        return 0;
    }
    while (length < LEAST) {
        bytes[length++] = CARRYSTEP_END;
    }
    return length;
}

static bool transfer(int port, uint8_t *bytes, size_t length)
{
    struct spi_ioc_transfer message;
    memset(&message, 0, sizeof message);
    message.tx_buf = (uintptr_t)bytes;
    message.rx_buf = (uintptr_t)bytes;
    message.len = (uint32_t)length;
    return ioctl(port, SPI_IOC_MESSAGE(1), &message) >= 0;
}

/* Goes on as long as one side has something to say. */
static bool exchange(carrystep_line *line, carrystep_pump *pump)
{
    for (unsigned round = 0; round < TRANSFERS; round++) {
        uint8_t bytes[MOST];
        size_t requests;
        bool says = false;
        carrystep_pump_run(pump, carrystep_now_us());
        size_t length = compose(pump, bytes, &requests);
        if (length == 0) {
            return true;
        }
        if (!transfer(line->port, bytes, length)) {
            return false;
        }
        uint64_t now = carrystep_now_us();
        for (size_t at = 0; at < length; at++) {
            says = says || bytes[at] != CARRYSTEP_END;
            carrystep_pump_receive(pump, now, bytes[at]);
        }
        if (requests == 0 && !says) {
            return true;
        }
    }
    return true;
}

const carrystep_line_kind carrystep_spi = {is, prepare, nap, exchange, WINDOW};

/* A stand-in for spidev in simulated time: the test has the board, the bus and the clock.
 *
 *     prepare hz     "is prepared mode bits hz window": what carrystep_spi.c has set
 *     spi now_us     one round of carrystep_spi.c. For each transfer it prints "x HEX", and reads
 *                    "HEX now_us", the bytes that have come and the time behind them; or
 *                    "gone now_us", and the transfer fails. "end" follows the last one. */
#include "spi_bench.h"

#include <inttypes.h>
#include <linux/spi/spidev.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t now;
static struct {
    unsigned mode, bits, hz;
} set = {99, 99, 0};

uint64_t carrystep_now_us(void)
{
    return now;
}

static int transfer(const struct spi_ioc_transfer *message)
{
    static char text[1 << 13];
    const uint8_t *out = (const uint8_t *)(uintptr_t)message->tx_buf;
    uint8_t *in = (uint8_t *)(uintptr_t)message->rx_buf;
    printf("x ");
    for (uint32_t at = 0; at < message->len; at++) {
        printf("%02x", out[at]);
    }
    printf("\n");
    fflush(stdout);
    if (scanf("%8191s %" SCNu64, text, &now) != 2) {
        exit(1);
    }
    if (strcmp(text, "gone") == 0) {
        return -1;
    }
    for (uint32_t at = 0; at < message->len; at++) {
        char pair[3] = {text[2u * at], text[2u * at + 1u], 0};
        in[at] = (uint8_t)strtoul(pair, NULL, 16);
    }
    return (int)message->len;
}

int __wrap_ioctl(int port, unsigned long request, ...);

int __wrap_ioctl(int port, unsigned long request, ...)
{
    va_list words;
    (void)port;
    va_start(words, request);
    void *data = va_arg(words, void *);
    va_end(words);
    if (request == SPI_IOC_MESSAGE(1)) {
        return transfer(data);
    }
    if (request == SPI_IOC_WR_MODE) {
        set.mode = *(uint8_t *)data;
    } else if (request == SPI_IOC_WR_BITS_PER_WORD) {
        set.bits = *(uint8_t *)data;
    } else if (request == SPI_IOC_WR_MAX_SPEED_HZ) {
        set.hz = *(uint32_t *)data;
    } else if (request != SPI_IOC_RD_MODE) {
        return -1;
    }
    return 0;
}

bool spi_bench(const char *word, carrystep_shared *shared, carrystep_pump *pump)
{
    static carrystep_line line;
    if (strcmp(word, "prepare") == 0) {
        carrystep_rates rates = {0, 0};
        if (scanf("%" SCNu32, &rates.sck_hz) != 1) {
            exit(1);
        }
        bool is = carrystep_spi.is(7), prepared = carrystep_spi.prepare(7, &rates) == 0;
        printf("%d %d %u %u %u %u\n", is, prepared, set.mode, set.bits, set.hz, carrystep_spi.window);
        return true;
    }
    if (strcmp(word, "spi") == 0) {
        if (scanf("%" SCNu64, &now) != 1) {
            exit(1);
        }
        /* As carrystep_port.c does. */
        bool there = carrystep_spi.wait(&line);
        if (pump->state != CARRYSTEP_PUMP_GONE && (!there || !carrystep_spi.exchange(&line, pump))) {
            carrystep_pump_away(shared, CARRYSTEP_FAULT_NO_PORT);
            pump->state = CARRYSTEP_PUMP_GONE;
        }
        printf("end\n");
        return true;
    }
    return false;
}

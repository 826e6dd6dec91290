/* The two lines to a board: a serial port (carrystep_uart.c), and an SPI by Linux' spidev
 * (carrystep_spi.c). carrystep_port.c opens a device, and asks it which of them it is. */
#ifndef CARRYSTEP_LINE_H
#define CARRYSTEP_LINE_H

#include "carrystep_pump.h"

/* The rates of both lines. */
typedef struct {
    uint32_t baud;   /* of a serial port, bit/s */
    uint32_t sck_hz; /* of an SPI: SCK, Hz, at most a fifth of the gateware's clock */
} carrystep_rates;

/* A device that is open. */
typedef struct {
    int port;             /* its descriptor */
    size_t length, sent;  /* of `bytes`; a serial port may take a part of them */
    uint8_t bytes[CARRYSTEP_LINE_BYTES];
} carrystep_line;

/* What differs between the lines. */
typedef struct {
    /* Whether the device is of this kind. */
    bool (*is)(int port);
    /* Prepares the device. Returns 0, CARRYSTEP_FAULT_NO_PORT or CARRYSTEP_FAULT_PORT_BUSY. */
    uint32_t (*prepare)(int port, const carrystep_rates *rates);
    /* Waits 1 ms at most, a serial port until bytes come. False if the device has gone. */
    bool (*wait)(carrystep_line *line);
    /* Passes what is due in both directions, and runs the pump. False if the device has gone. */
    bool (*exchange)(carrystep_line *line, carrystep_pump *pump);
    /* Greatest number of unacknowledged writes on the line, or 0 for CARRYSTEP_SLOTS. */
    uint8_t window;
} carrystep_line_kind;

extern const carrystep_line_kind carrystep_uart;
extern const carrystep_line_kind carrystep_spi;

/* Whether serial ports can be set to this rate, bit/s. */
bool carrystep_uart_has_rate(uint32_t baud);

/* The time, us, of a clock that never goes back. carrystep_port.c has the computer's; tests have
 * their own. */
uint64_t carrystep_now_us(void);

#endif

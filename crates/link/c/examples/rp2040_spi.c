/* An RP2040 (Raspberry Pi Pico) drives the gateware over SPI: it connects, powers the drivers,
 * makes one move and removes the power.
 *
 *     Pico GP16 (SPI0 RX)  <- MISO        CMakeLists.txt:
 *     Pico GP17            -> CS              add_executable(move rp2040_spi.c carrystep_frame.c
 *     Pico GP18 (SPI0 SCK) -> SCK                 carrystep_session.c carrystep_feeder.c)
 *     Pico GP19 (SPI0 TX)  -> MOSI            target_link_libraries(move pico_stdlib hardware_spi)
 *
 * Only setup(), exchange() and now() depend on the RP2040; for another microcontroller, replace
 * these three. The numbers of a move come from a planner on a PC, or from integers as below. */
#include "carrystep_feeder.h"

#include "hardware/gpio.h"
#include "hardware/spi.h"
#include "pico/stdlib.h"

#define BAUD (5u * 1000u * 1000u) /* at most a fifth of the gateware's clock */
#define CHIP_SELECT 17u
#define AXES 6u
#define SESSION 0x2040u /* any number from 1 on that no other host of this gateware uses */

/* Build id of the gateware that the move was planned for: its registers BUILD_HIGH and BUILD_LOW.
 */
#ifndef BUILD_ID
#define BUILD_ID UINT64_C(0x0123456789abcdef)
#endif

static carrystep_session session;
static carrystep_feeder program;

/* ---- functions that depend on the microcontroller ---- */

static void setup(void)
{
    spi_init(spi0, BAUD);
    spi_set_format(spi0, 8, SPI_CPOL_0, SPI_CPHA_0, SPI_MSB_FIRST);
    gpio_set_function(16u, GPIO_FUNC_SPI);
    gpio_set_function(18u, GPIO_FUNC_SPI);
    gpio_set_function(19u, GPIO_FUNC_SPI);
    gpio_init(CHIP_SELECT);
    gpio_set_dir(CHIP_SELECT, GPIO_OUT);
    gpio_put(CHIP_SELECT, false); /* low for good */
}

/* Transfers bytes in both directions at once. */
static void exchange(const uint8_t *out, uint8_t *in, size_t length)
{
    spi_write_read_blocking(spi0, out, in, length);
}

static uint32_t now(void)
{
    return to_ms_since_boot(get_absolute_time());
}

/* ---- functions that do not ---- */

/* One exchange: sends the next request, or END if there is none. True if *answer is new. */
static bool turn(carrystep_answer *answer)
{
    uint8_t out[CARRYSTEP_LINE_BYTES];
    uint8_t in[CARRYSTEP_LINE_BYTES];
    size_t length = carrystep_transmit(&session, now(), out);
    bool heard = false;
    while (length < 16u) {
        out[length++] = CARRYSTEP_END;
    }
    exchange(out, in, length);
    for (size_t at = 0; at < length; at++) {
        heard = carrystep_receive(&session, in[at], now(), answer) == CARRYSTEP_HEARD || heard;
    }
    return heard;
}

/* Reads a register. False if nothing answers. */
static bool ask(uint8_t address, carrystep_answer *answer)
{
    uint32_t begin = now();
    if (!carrystep_read(&session, address)) {
        return false;
    }
    while (now() - begin < 500u) {
        if (turn(answer) && answer->address == address) {
            return true;
        }
    }
    return false;
}

/* Opens a session. False if the gateware is busy for another host, or does not answer. */
static bool open_session(void)
{
    carrystep_answer answer;
    uint32_t begin = now();
    carrystep_open(&session, SESSION, AXES);
    while (carrystep_opening(&session) && now() - begin < 500u) {
        turn(&answer);
    }
    return carrystep_owns(&session);
}

/* Reads the facts of the gateware, and opens a session. False if this program was not made for it;
 * then nothing was written. */
static bool connect(void)
{
    carrystep_answer identity, protocol, low, high;
    carrystep_begin(&session, 5u, 1u);
    carrystep_limit(&session, 6u); /* more could be lost over SPI (docs/protocol.md) */
    if (!ask(CARRYSTEP_IDENTITY, &identity) || !ask(CARRYSTEP_PROTOCOL, &protocol) || !ask(CARRYSTEP_BUILD_LOW, &low) ||
        !ask(CARRYSTEP_BUILD_HIGH, &high)) {
        return false;
    }
    if (carrystep_check(identity.data, protocol.data, (uint64_t)high.data << 32 | low.data, BUILD_ID) !=
        CARRYSTEP_FINE) {
        return false;
    }
    return open_session();
}

/* A move of axis 0 at a tick of 2 us: half a second of acceleration to 5000 steps/s and half a
 * second of deceleration, exactly 2500 steps. */
static const carrystep_segment move[] = {
    {250000u, INT64_C(368934881474), INT64_C(737869762948), 0, false, 0},
    {40000u, INT64_C(184467071802214043), INT64_C(-737869762948), 0, false, 0},
    {210000u, INT64_C(154952281284294042), INT64_C(-737869762948), 0, true, 0},
};

typedef struct {
    unsigned segment;
    bool started;
} place;

static bool next_segment(void *context, uint8_t axis, carrystep_segment *next)
{
    place *at = context;
    if (axis != 0 || at->segment == sizeof move / sizeof move[0]) {
        return false;
    }
    *next = move[at->segment++];
    return true;
}

static bool next_start(void *context, uint8_t *mask)
{
    place *at = context;
    bool first = !at->started;
    at->started = true;
    *mask = 1u;
    return first;
}

/* Powers the drivers and executes the move. True if the move was completed; false if it could not
 * begin, or if a fault stopped it. */
static bool run(void)
{
    place at = {0, false};
    carrystep_source source = {next_segment, next_start, &at};
    carrystep_answer answer;
    carrystep_fed fed = CARRYSTEP_FEEDING;
    uint32_t looked = now();
    carrystep_load(&program, source);
    for (;;) {
        bool over = fed == CARRYSTEP_FED && !carrystep_writing(&session);
        bool heard = turn(&answer);
        if (!carrystep_owns(&session) || (heard && answer.fault)) {
            return false; /* another host has the gateware; or answer.cause says why all axes stop */
        }
        if (heard && over && answer.idle) {
            return true;
        }
        fed = carrystep_feed(&session, &program);
        if (fed == CARRYSTEP_BAD_SOURCE || fed == CARRYSTEP_NO_POWER) {
            return false;
        }
        /* Reads the position from time to time, which also restarts the watchdog. */
        if (now() - looked >= 10u) {
            looked = now();
            carrystep_read(&session, CARRYSTEP_POSITION);
        }
    }
}

int main(void)
{
    carrystep_answer answer;
    setup();
    if (!connect()) {
        return 1;
    }
    carrystep_write(&session, CARRYSTEP_CONTROL, CARRYSTEP_CONTROL_ENABLE);
    do {
        if (!ask(CARRYSTEP_POSITION, &answer)) {
            return 1;
        }
    } while (!answer.ready);
    if (!run()) {
        return 1;
    }
    carrystep_write(&session, CARRYSTEP_CONTROL, 0);
    while (carrystep_writing(&session)) {
        turn(&answer);
    }
    return 0;
}

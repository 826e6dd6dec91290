/* The component without HAL and port, in simulated time: a line is answered by a line. */
#include "spi_bench.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static carrystep_shared shared;
static carrystep_servo servo;
static carrystep_pump pump;
static carrystep_pump_how how;
static struct {
    unsigned outputs, pwm, probe, index, window;
} has = {0, 0, CARRYSTEP_NO_LATCH, CARRYSTEP_NO_LATCH, 0};
static struct {
    unsigned homing, index, levels;
    double duty;
} asks;
static double scale[CARRYSTEP_MOST_AXES], most[CARRYSTEP_MOST_AXES];

/* "begin axes periods horizon_us build scale most" */
static void begin(void)
{
    unsigned axes, periods;
    double of_all, fastest;
    memset(&how, 0, sizeof how);
    if (scanf("%u %u %" SCNu64 " %" SCNx64 " %lf %lf", &axes, &periods, &how.horizon_ns, &how.build, &of_all,
              &fastest) != 6) {
        exit(1);
    }
    how.horizon_ns *= 1000u;
    how.axes = (uint8_t)axes;
    how.number = 77;
    how.probe_latch = (uint8_t)has.probe;
    how.index_latch = (uint8_t)has.index;
    how.window = (uint8_t)has.window;
    for (unsigned axis = 0; axis < axes; axis++) {
        scale[axis] = of_all;
        most[axis] = fastest;
    }
    carrystep_share(&shared);
    carrystep_servo_begin(&servo, &shared, how.axes, periods);
    servo.outputs = (uint8_t)has.outputs;
    servo.pwm = has.pwm != 0;
    carrystep_pump_begin(&pump, &shared, &how, 0);
    printf("ok\n");
}

/* "servo period_ns enable command ...": "code running fault culprits lead reserve index inputs
 * feedback ..." */
static void run_servo(void)
{
    carrystep_servo_in in;
    carrystep_servo_out out;
    long period;
    int enable;
    memset(&in, 0, sizeof in);
    memset(&out, 0, sizeof out);
    if (scanf("%ld %d", &period, &enable) != 2) {
        exit(1);
    }
    in.enable = enable != 0;
    in.homing = (uint8_t)asks.homing;
    in.index = (uint8_t)asks.index;
    in.levels = (uint8_t)asks.levels;
    in.duty = asks.duty;
    for (unsigned axis = 0; axis < servo.axes; axis++) {
        if (scanf("%lf", &in.command[axis]) != 1) {
            exit(1);
        }
        in.scale[axis] = scale[axis];
        in.most[axis] = most[axis];
    }
    carrystep_servo_run(&servo, period, &in, &out);
    asks.index = out.index;
    printf("%" PRIu32 " %d %d %u %" PRId64 " %" PRId64 " %u %" PRIu32, out.fault_code, out.running, out.fault,
           out.culprits, servo.report.lead_ns, servo.report.reserve_ns, out.index, servo.report.inputs);
    for (unsigned axis = 0; axis < servo.axes; axis++) {
        printf(" %.17g", out.feedback[axis]);
    }
    printf("\n");
}

/* "line now_us hex": the bytes to send, in hex. A `-` ends each of them. */
static void run_line(void)
{
    static char text[1 << 16];
    uint64_t now;
    uint8_t line[CARRYSTEP_LINE_BYTES];
    if (scanf("%" SCNu64 " %65535s", &now, text) != 2) {
        exit(1);
    }
    for (size_t at = 0; text[at] != '-'; at += 2) {
        char pair[3] = {text[at], text[at + 1], 0};
        carrystep_pump_receive(&pump, now, (uint8_t)strtoul(pair, NULL, 16));
    }
    carrystep_pump_run(&pump, now);
    for (size_t length; (length = carrystep_pump_transmit(&pump, now, line)) > 0;) {
        for (size_t at = 0; at < length; at++) {
            printf("%02x", line[at]);
        }
    }
    printf("-\n");
}

int main(void)
{
    char word[16];
    while (scanf("%15s", word) == 1) {
        if (strcmp(word, "begin") == 0) {
            begin();
        } else if (strcmp(word, "servo") == 0) {
            run_servo();
        } else if (strcmp(word, "line") == 0) {
            run_line();
        } else if (strcmp(word, "again") == 0) {
            /* What carrystep_port does when the port can be opened again. */
            carrystep_pump_begin(&pump, &shared, &how, pump.now);
            printf("ok\n");
        } else if (strcmp(word, "has") == 0) {
            /* "has outputs pwm probe index window": the board, and the line; before "begin" */
            if (scanf("%u %u %u %u %u", &has.outputs, &has.pwm, &has.probe, &has.index, &has.window) != 5) {
                return 1;
            }
            printf("ok\n");
        } else if (strcmp(word, "asks") == 0) {
            /* "asks homing index levels duty": the pins of the next periods */
            if (scanf("%u %u %u %lf", &asks.homing, &asks.index, &asks.levels, &asks.duty) != 4) {
                return 1;
            }
            printf("ok\n");
        } else if (strcmp(word, "scale") == 0) {
            scale[0] *= 2;
            printf("ok\n");
        } else if (!spi_bench(word, &shared, &pump)) {
            return 1;
        }
        fflush(stdout);
    }
    return 0;
}

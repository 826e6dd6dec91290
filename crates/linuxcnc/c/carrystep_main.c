/* carrystep.so: the HAL component of LinuxCNC for a board with the carrystep engine.
 *
 *     loadrt carrystep port=/dev/ttyUSB1 joints=3 periods=4 horizon=40
 *     addf carrystep.0.update servo-thread
 *
 * The function `update` never waits: it makes blocks of the position commands (carrystep_servo.h).
 * A thread of its own talks with the board (carrystep_port.h). This file has the parameters of
 * loadrt and the messages; carrystep_pins.h has the pins. */
#include "rtapi.h"
#include "rtapi_app.h"
#include "hal.h"

#include "carrystep_pins.h"
#include "carrystep_port.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

MODULE_AUTHOR("the authors of carrystep");
MODULE_DESCRIPTION("Stepper motors by segments: the carrystep engine in an FPGA");
MODULE_LICENSE("GPL"); /* what is linked with LinuxCNC; the sources are MIT or Apache-2.0 */

static char *port = "";
RTAPI_MP_STRING(port, "serial port or spidev of the board");
static int baud = 921600;
RTAPI_MP_INT(baud, "rate of a serial port, bit/s");
static int speed = 1000000;
RTAPI_MP_INT(speed, "rate of an SPI (its SCK), Hz");
static int joints = 3;
RTAPI_MP_INT(joints, "number of joints, 1 to 8: joint N is axis N of the board");
static int periods = 4;
RTAPI_MP_INT(periods, "servo periods in a segment, 1 to 64");
static int horizon = 40;
RTAPI_MP_INT(horizon, "time from a command to its pulses, ms");
static char *build = "0";
RTAPI_MP_STRING(build, "build id that the gateware must have, hexadecimal; 0: any");
static int outputs = 0;
RTAPI_MP_INT(outputs, "number of outputs that the build has, 0 to 8");
static int pwm = 0;
RTAPI_MP_INT(pwm, "1: the build has a PWM");
static int probe_latch = -1;
RTAPI_MP_INT(probe_latch, "number of the latch at the probe's pin, 0 to 3; -1: none");
static int index_latch = -1;
RTAPI_MP_INT(index_latch, "number of the latch for index pulses, 0 to 3; -1: none");

static int component_id;
static carrystep_shared shared;
static carrystep_servo servo;
static carrystep_port thread;
static uint32_t told;
static long long called; /* time of the latest call, ns */

/* One message for each fault that begins. */
static void say(const carrystep_servo_out *out)
{
    if (out->fault_code != told && out->fault_code != 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "carrystep: fault %u: %s (joints 0x%x; 0: all)\n", out->fault_code,
                        carrystep_fault_text(out->fault_code), out->culprits);
    }
    told = out->fault_code;
}

static void update(void *context, long period)
{
    carrystep_servo_in in;
    carrystep_servo_out out;
    long long now = rtapi_get_time();
    double pause_ms = called != 0 ? (double)(now - called) * 1e-6 : 0.0;
    (void)context;
    called = now;
    memset(&out, 0, sizeof out);
    carrystep_pins_read(&in);
    carrystep_servo_run(&servo, period, &in, &out);
    carrystep_pins_show(&servo, &out, pause_ms);
    say(&out);
}

/* The build id of the parameter `build`; false if it is not hexadecimal. */
static bool build_id(uint64_t *id)
{
    char *rest;
    *id = strtoull(build, &rest, 16);
    return *build != '\0' && *rest == '\0';
}

/* What is wrong with the parameters; NULL: nothing. */
static const char *mistake(carrystep_pump_how *how)
{
    if (*port == '\0') {
        return "the parameter port is missing: loadrt carrystep port=/dev/ttyUSB1";
    }
    if (!carrystep_uart_has_rate((uint32_t)baud)) {
        return "the parameter baud is not a rate of serial ports, such as 921600";
    }
    if (speed < 10000 || speed > 50000000) {
        return "the parameter speed must be 10000 to 50000000 Hz";
    }
    if (joints < 1 || joints > (int)CARRYSTEP_MOST_AXES) {
        return "the parameter joints must be 1 to 8";
    }
    if (periods < 1 || periods > (int)CARRYSTEP_MOST_PERIODS) {
        return "the parameter periods must be 1 to 64";
    }
    if (horizon < 1 || horizon > 1000) {
        return "the parameter horizon must be 1 to 1000 ms";
    }
    if (!build_id(&how->build)) {
        return "the parameter build must be a hexadecimal number, as `carrystep status` prints it";
    }
    if (outputs < 0 || outputs > 8) {
        return "the parameter outputs must be 0 to 8";
    }
    if (probe_latch < -1 || probe_latch > 3 || index_latch < -1 || index_latch > 3) {
        return "the parameters probe_latch and index_latch must be 0 to 3, or -1 for none";
    }
    if (probe_latch >= 0 && probe_latch == index_latch) {
        return "the parameters probe_latch and index_latch name the same latch";
    }
    return NULL;
}

static int refuse(const char *what)
{
    rtapi_print_msg(RTAPI_MSG_ERR, "carrystep: %s\n", what);
    return -EINVAL;
}

int rtapi_app_main(void)
{
    carrystep_pump_how how;
    carrystep_shape shape = {joints, outputs, pwm != 0};
    memset(&how, 0, sizeof how);
    const char *wrong = mistake(&how);
    if (wrong != NULL) {
        return refuse(wrong);
    }
    int id = hal_init("carrystep");
    if (id < 0) {
        return id; /* loaded already, for example: the one that runs keeps its number */
    }
    component_id = id;
    int bad = carrystep_pins_export(component_id, &shape);
    if (bad == 0) {
        bad = hal_export_funct("carrystep.0.update", update, NULL, 1, 0, component_id);
    }
    if (bad != 0) {
        hal_exit(component_id);
        return bad;
    }
    how.axes = (uint8_t)joints;
    how.horizon_ns = (uint64_t)horizon * 1000000u;
    how.probe_latch = probe_latch < 0 ? CARRYSTEP_NO_LATCH : (uint8_t)probe_latch;
    how.index_latch = index_latch < 0 ? CARRYSTEP_NO_LATCH : (uint8_t)index_latch;
    carrystep_share(&shared);
    carrystep_servo_begin(&servo, &shared, how.axes, (uint32_t)periods);
    servo.outputs = (uint8_t)((1u << outputs) - 1u);
    servo.pwm = shape.pwm;
    thread.shared = &shared;
    thread.how = how;
    thread.path = port;
    thread.rates.baud = (uint32_t)baud;
    thread.rates.sck_hz = (uint32_t)speed;
    if (carrystep_port_begin(&thread) != 0) {
        hal_exit(component_id);
        return refuse("the system starts no thread");
    }
    hal_ready(component_id);
    return 0;
}

void rtapi_app_exit(void)
{
    carrystep_port_end(&thread);
    hal_exit(component_id);
}

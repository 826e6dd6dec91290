/* carrystep.so: the HAL component of LinuxCNC for a board with the carrystep engine.
 *
 *     loadrt carrystep port=/dev/ttyUSB1 joints=3 periods=4 horizon=40
 *     addf carrystep.0.update servo-thread
 *
 * The function `update` never waits: it makes blocks of the position commands (carrystep_servo.h).
 * A thread of its own talks with the board (carrystep_port.h). This file only gives both their pins
 * and parameters. */
#include "rtapi.h"
#include "rtapi_app.h"
#include "hal.h"

#include "carrystep_port.h"

#include <stdlib.h>
#include <string.h>

MODULE_AUTHOR("the authors of carrystep");
MODULE_DESCRIPTION("Stepper motors by segments: the carrystep engine in an FPGA");
MODULE_LICENSE("GPL"); /* what is linked with LinuxCNC; the sources are MIT or Apache-2.0 */

static char *port = "";
RTAPI_MP_STRING(port, "serial port of the board");
static int baud = 921600;
RTAPI_MP_INT(baud, "rate of the port, bit/s");
static int joints = 3;
RTAPI_MP_INT(joints, "number of joints, 1 to 8: joint N is axis N of the board");
static int periods = 4;
RTAPI_MP_INT(periods, "servo periods in a segment, 1 to 64");
static int horizon = 40;
RTAPI_MP_INT(horizon, "time from a command to its pulses, ms");
static char *build = "0";
RTAPI_MP_STRING(build, "build id that the gateware must have, hexadecimal; 0: any");

#define INPUT_ROWS 2
#define ROW_INPUTS 8

typedef struct {
    struct {
        hal_float_t *position_cmd;
        hal_float_t *position_fb;
        hal_float_t *error;
        hal_bit_t *enable;
        hal_bit_t *fault;
        hal_bit_t *limit_min;
        hal_bit_t *limit_max;
        hal_float_t scale;
        hal_float_t maxvel;
    } joints[CARRYSTEP_MOST_AXES];
    hal_bit_t *running;
    hal_bit_t *connected;
    hal_bit_t *fault;
    hal_u32_t *fault_code;
    hal_float_t *lead;
    hal_float_t *reserve;
    hal_float_t *reserve_min;
    hal_float_t *trim;
    hal_u32_t *end_ticks;
    hal_float_t *thread_pause;
    hal_float_t *servo_pause;
    hal_bit_t *inputs[INPUT_ROWS][ROW_INPUTS];
} component;

static int component_id;
static component *pins;
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

static void show(const carrystep_servo_out *out)
{
    const carrystep_report *report = &servo.report;
    double lead = (double)report->lead_ns * 1e-6;
    bool known = out->running && report->stream == servo.stream;
    *pins->running = out->running;
    *pins->connected = report->state != CARRYSTEP_AWAY;
    *pins->fault = out->fault;
    *pins->fault_code = out->fault_code;
    *pins->trim = (double)report->trim * 1e-3;
    *pins->thread_pause = (double)__atomic_load_n(&shared.pause_us, __ATOMIC_RELAXED) * 1e-3;
    *pins->end_ticks = known ? (hal_u32_t)(servo.blocks.ticks + report->rest) : 0;
    if (known) {
        double reserve = (double)report->reserve_ns * 1e-6;
        bool first = *pins->lead == 0;
        *pins->reserve_min = first || reserve < *pins->reserve_min ? reserve : *pins->reserve_min;
        *pins->reserve = reserve;
        *pins->lead = lead;
    }
    for (int row = 0; row < INPUT_ROWS; row++) {
        for (int input = 0; input < ROW_INPUTS; input++) {
            *pins->inputs[row][input] = (report->inputs >> (16 + 8 * row + input) & 1u) != 0;
        }
    }
    for (int joint = 0; joint < joints; joint++) {
        *pins->joints[joint].position_fb = out->feedback[joint];
        *pins->joints[joint].fault = out->fault;
        *pins->joints[joint].error = known ? report->error[joint] : 0.0;
        *pins->joints[joint].limit_min = (report->inputs >> joint & 1u) != 0;
        *pins->joints[joint].limit_max = (report->inputs >> (8 + joint) & 1u) != 0;
    }
    say(out);
}

static void update(void *context, long period)
{
    carrystep_servo_in in;
    carrystep_servo_out out;
    (void)context;
    memset(&in, 0, sizeof in);
    memset(&out, 0, sizeof out);
    long long now = rtapi_get_time();
    double pause = (double)(now - called) * 1e-6;
    if (called != 0 && pause > *pins->servo_pause) {
        *pins->servo_pause = pause;
    }
    called = now;
    in.enable = true;
    for (int joint = 0; joint < joints; joint++) {
        in.enable = in.enable && *pins->joints[joint].enable;
        in.command[joint] = *pins->joints[joint].position_cmd;
        in.scale[joint] = pins->joints[joint].scale;
        in.most[joint] = pins->joints[joint].maxvel;
    }
    carrystep_servo_run(&servo, period, &in, &out);
    show(&out);
}

static int export_joint(int joint)
{
    int bad = 0;
#define PIN(type, direction, field, name) \
    bad |= hal_pin_##type##_newf(direction, &pins->joints[joint].field, component_id, "carrystep.0.joint.%d." name, joint)
    PIN(float, HAL_IN, position_cmd, "position-cmd");
    PIN(float, HAL_OUT, position_fb, "position-fb");
    PIN(float, HAL_OUT, error, "error");
    PIN(bit, HAL_IN, enable, "enable");
    PIN(bit, HAL_OUT, fault, "fault");
    PIN(bit, HAL_OUT, limit_min, "limit-min");
    PIN(bit, HAL_OUT, limit_max, "limit-max");
#undef PIN
    bad |= hal_param_float_newf(HAL_RW, &pins->joints[joint].scale, component_id, "carrystep.0.joint.%d.scale", joint);
    bad |= hal_param_float_newf(HAL_RW, &pins->joints[joint].maxvel, component_id, "carrystep.0.joint.%d.maxvel", joint);
    pins->joints[joint].scale = 1.0;
    return bad;
}

static int export_all(void)
{
    int bad = 0;
    for (int joint = 0; joint < joints; joint++) {
        bad |= export_joint(joint);
    }
    bad |= hal_pin_bit_newf(HAL_OUT, &pins->running, component_id, "carrystep.0.running");
    bad |= hal_pin_bit_newf(HAL_OUT, &pins->connected, component_id, "carrystep.0.connected");
    bad |= hal_pin_bit_newf(HAL_OUT, &pins->fault, component_id, "carrystep.0.fault");
    bad |= hal_pin_u32_newf(HAL_OUT, &pins->fault_code, component_id, "carrystep.0.fault-code");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->lead, component_id, "carrystep.0.lead-ms");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->reserve, component_id, "carrystep.0.reserve-ms");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->reserve_min, component_id, "carrystep.0.reserve-min-ms");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->trim, component_id, "carrystep.0.trim-ppm");
    bad |= hal_pin_u32_newf(HAL_OUT, &pins->end_ticks, component_id, "carrystep.0.end-ticks");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->thread_pause, component_id, "carrystep.0.thread-pause-ms");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->servo_pause, component_id, "carrystep.0.servo-pause-ms");
    for (int row = 0; row < INPUT_ROWS; row++) {
        for (int input = 0; input < ROW_INPUTS; input++) {
            static const char *const FIRST[INPUT_ROWS] = {"probe", "interlock"};
            bad |= input == 0 ? hal_pin_bit_newf(HAL_OUT, &pins->inputs[row][input], component_id, "carrystep.0.%s",
                                                 FIRST[row])
                              : hal_pin_bit_newf(HAL_OUT, &pins->inputs[row][input], component_id,
                                                 "carrystep.0.in-%d-%d", input, row);
        }
    }
    return bad | hal_export_funct("carrystep.0.update", update, NULL, 1, 0, component_id);
}

/* The build id of the parameter `build`; false if it is not hexadecimal. */
static bool build_id(uint64_t *id)
{
    char *rest;
    *id = strtoull(build, &rest, 16);
    return *build != '\0' && *rest == '\0';
}

static int refuse(const char *what)
{
    rtapi_print_msg(RTAPI_MSG_ERR, "carrystep: %s\n", what);
    return -EINVAL;
}

int rtapi_app_main(void)
{
    carrystep_pump_how how;
    memset(&how, 0, sizeof how);
    if (*port == '\0') {
        return refuse("the parameter port is missing: loadrt carrystep port=/dev/ttyUSB1");
    }
    if (!carrystep_port_has_rate((uint32_t)baud)) {
        return refuse("the parameter baud is not a rate of serial ports, such as 921600");
    }
    if (joints < 1 || joints > (int)CARRYSTEP_MOST_AXES) {
        return refuse("the parameter joints must be 1 to 8");
    }
    if (periods < 1 || periods > (int)CARRYSTEP_MOST_PERIODS) {
        return refuse("the parameter periods must be 1 to 64");
    }
    if (horizon < 1 || horizon > 1000) {
        return refuse("the parameter horizon must be 1 to 1000 ms");
    }
    if (!build_id(&how.build)) {
        return refuse("the parameter build must be a hexadecimal number, as `carrystep status` prints it");
    }
    component_id = hal_init("carrystep");
    if (component_id < 0) {
        return component_id;
    }
    pins = hal_malloc(sizeof *pins);
    if (pins == NULL) {
        hal_exit(component_id);
        return -ENOMEM;
    }
    memset(pins, 0, sizeof *pins);
    if (export_all() != 0) {
        hal_exit(component_id);
        return -EINVAL;
    }
    how.axes = (uint8_t)joints;
    how.horizon_ns = (uint64_t)horizon * 1000000u;
    carrystep_share(&shared);
    carrystep_servo_begin(&servo, &shared, how.axes, (uint32_t)periods);
    thread.shared = &shared;
    thread.how = how;
    thread.path = port;
    thread.baud = (uint32_t)baud;
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

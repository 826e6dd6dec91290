/* See carrystep_pins.h. */
#include "rtapi.h"
#include "hal.h"

#include "carrystep_pins.h"

#include <errno.h>
#include <string.h>

#define INPUT_ROWS 2
#define ROW_INPUTS 8
#define OUTPUTS 8

typedef struct {
    struct {
        hal_float_t *position_cmd;
        hal_float_t *position_fb;
        hal_float_t *error;
        hal_bit_t *enable;
        hal_bit_t *homing;
        hal_bit_t *index_enable;
        hal_bit_t *fault;
        hal_bit_t *limit_min;
        hal_bit_t *limit_max;
        hal_float_t scale;
        hal_float_t maxvel;
    } joints[CARRYSTEP_MOST_AXES];
    hal_bit_t *running;
    hal_bit_t *connected;
    hal_bit_t *fault;
    hal_bit_t *estop;
    hal_u32_t *fault_code;
    hal_float_t *lead;
    hal_float_t *reserve;
    hal_float_t *reserve_min;
    hal_float_t *trim;
    hal_u32_t *end_ticks;
    hal_float_t *thread_pause;
    hal_float_t *servo_pause;
    hal_bit_t *inputs[INPUT_ROWS][ROW_INPUTS];
    hal_bit_t *outputs[OUTPUTS];
    hal_float_t *duty;
    hal_float_t duty_scale;
} all_pins;

static all_pins *pins;
static carrystep_shape shape;

static int export_joint(int id, int joint)
{
    int bad = 0;
#define PIN(type, direction, field, name) \
    bad |= hal_pin_##type##_newf(direction, &pins->joints[joint].field, id, "carrystep.0.joint.%d." name, joint)
    PIN(float, HAL_IN, position_cmd, "position-cmd");
    PIN(float, HAL_OUT, position_fb, "position-fb");
    PIN(float, HAL_OUT, error, "error");
    PIN(bit, HAL_IN, enable, "enable");
    PIN(bit, HAL_IN, homing, "homing");
    PIN(bit, HAL_IO, index_enable, "index-enable");
    PIN(bit, HAL_OUT, fault, "fault");
    PIN(bit, HAL_OUT, limit_min, "limit-min");
    PIN(bit, HAL_OUT, limit_max, "limit-max");
#undef PIN
    bad |= hal_param_float_newf(HAL_RW, &pins->joints[joint].scale, id, "carrystep.0.joint.%d.scale", joint);
    bad |= hal_param_float_newf(HAL_RW, &pins->joints[joint].maxvel, id, "carrystep.0.joint.%d.maxvel", joint);
    pins->joints[joint].scale = 1.0;
    return bad;
}

static int export_inputs(int id)
{
    static const char *const FIRST[INPUT_ROWS] = {"probe", "interlock"};
    int bad = 0;
    for (int row = 0; row < INPUT_ROWS; row++) {
        bad |= hal_pin_bit_newf(HAL_OUT, &pins->inputs[row][0], id, "carrystep.0.%s", FIRST[row]);
        for (int input = 1; input < ROW_INPUTS; input++) {
            bad |= hal_pin_bit_newf(HAL_OUT, &pins->inputs[row][input], id, "carrystep.0.in-%d-%d", input, row);
        }
    }
    return bad;
}

static int export_outputs(int id)
{
    int bad = 0;
    for (int output = 0; output < shape.outputs; output++) {
        bad |= hal_pin_bit_newf(HAL_IN, &pins->outputs[output], id, "carrystep.0.out-%d", output);
    }
    if (shape.pwm) {
        bad |= hal_pin_float_newf(HAL_IN, &pins->duty, id, "carrystep.0.pwm-duty");
        bad |= hal_param_float_newf(HAL_RW, &pins->duty_scale, id, "carrystep.0.pwm-scale");
        pins->duty_scale = 1.0;
    }
    return bad;
}

int carrystep_pins_export(int id, const carrystep_shape *wanted)
{
    int bad = 0;
    shape = *wanted;
    pins = hal_malloc(sizeof *pins);
    if (pins == NULL) {
        return -ENOMEM;
    }
    memset(pins, 0, sizeof *pins);
    for (int joint = 0; joint < shape.joints; joint++) {
        bad |= export_joint(id, joint);
    }
    bad |= hal_pin_bit_newf(HAL_OUT, &pins->running, id, "carrystep.0.running");
    bad |= hal_pin_bit_newf(HAL_OUT, &pins->connected, id, "carrystep.0.connected");
    bad |= hal_pin_bit_newf(HAL_OUT, &pins->fault, id, "carrystep.0.fault");
    bad |= hal_pin_bit_newf(HAL_OUT, &pins->estop, id, "carrystep.0.estop");
    bad |= hal_pin_u32_newf(HAL_OUT, &pins->fault_code, id, "carrystep.0.fault-code");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->lead, id, "carrystep.0.lead-ms");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->reserve, id, "carrystep.0.reserve-ms");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->reserve_min, id, "carrystep.0.reserve-min-ms");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->trim, id, "carrystep.0.trim-ppm");
    bad |= hal_pin_u32_newf(HAL_OUT, &pins->end_ticks, id, "carrystep.0.end-ticks");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->thread_pause, id, "carrystep.0.thread-pause-ms");
    bad |= hal_pin_float_newf(HAL_OUT, &pins->servo_pause, id, "carrystep.0.servo-pause-ms");
    bad |= export_inputs(id);
    bad |= export_outputs(id);
    return bad != 0 ? -EINVAL : 0;
}

void carrystep_pins_read(carrystep_servo_in *in)
{
    memset(in, 0, sizeof *in);
    in->enable = true;
    for (int joint = 0; joint < shape.joints; joint++) {
        in->enable = in->enable && *pins->joints[joint].enable;
        in->command[joint] = *pins->joints[joint].position_cmd;
        in->scale[joint] = pins->joints[joint].scale;
        in->most[joint] = pins->joints[joint].maxvel;
        in->homing = (uint8_t)(in->homing | (*pins->joints[joint].homing ? 1u << joint : 0u));
        in->index = (uint8_t)(in->index | (*pins->joints[joint].index_enable ? 1u << joint : 0u));
    }
    for (int output = 0; output < shape.outputs; output++) {
        in->levels = (uint8_t)(in->levels | (*pins->outputs[output] ? 1u << output : 0u));
    }
    if (shape.pwm) {
        in->duty = pins->duty_scale != 0 ? *pins->duty / pins->duty_scale : 0.0;
    }
}

/* What is known of the stream that runs. */
static void show_stream(const carrystep_servo *servo)
{
    const carrystep_report *report = &servo->report;
    double reserve = (double)report->reserve_ns * 1e-6;
    bool first = *pins->lead == 0;
    *pins->reserve_min = first || reserve < *pins->reserve_min ? reserve : *pins->reserve_min;
    *pins->reserve = reserve;
    *pins->lead = (double)report->lead_ns * 1e-6;
}

void carrystep_pins_show(const carrystep_servo *servo, const carrystep_servo_out *out, double pause_ms)
{
    const carrystep_report *report = &servo->report;
    bool known = out->running && report->stream == servo->stream;
    *pins->running = out->running;
    *pins->connected = report->state != CARRYSTEP_AWAY;
    *pins->fault = out->fault;
    *pins->fault_code = out->fault_code;
    *pins->estop = out->fault_code == CARRYSTEP_FAULT_STOP + CARRYSTEP_CAUSE_ESTOP;
    *pins->trim = (double)report->trim * 1e-3;
    *pins->thread_pause = (double)__atomic_load_n(&servo->shared->pause_us, __ATOMIC_RELAXED) * 1e-3;
    *pins->servo_pause = pause_ms > *pins->servo_pause ? pause_ms : *pins->servo_pause;
    *pins->end_ticks = known ? (hal_u32_t)(servo->blocks.ticks + report->rest) : 0;
    if (known) {
        show_stream(servo);
    }
    for (int row = 0; row < INPUT_ROWS; row++) {
        for (int input = 0; input < ROW_INPUTS; input++) {
            *pins->inputs[row][input] = (report->inputs >> (16 + 8 * row + input) & 1u) != 0;
        }
    }
    for (int joint = 0; joint < shape.joints; joint++) {
        *pins->joints[joint].position_fb = out->feedback[joint];
        *pins->joints[joint].fault = out->fault;
        *pins->joints[joint].error = known ? report->error[joint] : 0.0;
        *pins->joints[joint].limit_min = (report->inputs >> joint & 1u) != 0;
        *pins->joints[joint].limit_max = (report->inputs >> (8 + joint) & 1u) != 0;
        if (*pins->joints[joint].index_enable && (out->index >> joint & 1u) == 0) {
            *pins->joints[joint].index_enable = 0;
        }
    }
}

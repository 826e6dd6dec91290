/* See carrystep_servo.h. */
#include "carrystep_servo.h"

#include <string.h>

static const char *const OWN[] = {
    "no fault",
    "the port cannot be opened",
    "another program has the port",
    "no board answers at the port",
    "the board has another gateware than this component was configured for",
    "another program has taken the board, or the board was restarted",
    "the joints were enabled while the board was not ready",
    "the thread that talks with the board was late by more than all blocks that can wait",
    "the board is not where its segments led it",
    "a position-cmd is not a number",
    "a position-cmd is 2^31 steps from zero, or further",
    "a position-cmd jumps: it is faster than maxvel",
    "a position-cmd is faster than the engine can step",
    "the servo period has changed, or is too short or too long for a block",
    "a scale is 0 or not a number, or has changed in motion",
};

static const char *const STOPS[] = {
    "e-stop input", "overrun: steps came faster than the pin timing allows",
    "protocol fault", "watchdog: this computer was silent for too long",
    "overspeed", "limit switch", "underrun: this computer was later than the horizon",
    "a stop by another program", "interlock input",
};

const char *carrystep_fault_text(uint32_t fault)
{
    if (fault < sizeof OWN / sizeof OWN[0]) {
        return OWN[fault];
    }
    fault -= CARRYSTEP_FAULT_STOP;
    return fault < sizeof STOPS / sizeof STOPS[0] ? STOPS[fault] : "a stop of unknown cause";
}

void carrystep_share(carrystep_shared *shared)
{
    memset(shared, 0, sizeof *shared);
    carrystep_ring_begin(&shared->blocks, shared->block_cells, sizeof shared->block_cells[0], CARRYSTEP_BLOCK_CELLS);
    carrystep_ring_begin(&shared->reports, shared->report_cells, sizeof shared->report_cells[0],
                         CARRYSTEP_REPORT_CELLS);
}

void carrystep_servo_begin(carrystep_servo *servo, carrystep_shared *shared, uint8_t axes, uint32_t periods)
{
    memset(servo, 0, sizeof *servo);
    servo->shared = shared;
    servo->axes = axes;
    servo->periods = periods;
    servo->report.fault = CARRYSTEP_FAULT_NO_PORT;
}

static void end(carrystep_servo *servo)
{
    servo->stream = 0;
    __atomic_store_n(&servo->shared->wanted, 0u, __ATOMIC_RELEASE);
}

static void fail(carrystep_servo *servo, uint32_t fault, uint8_t culprits)
{
    servo->fault = fault;
    servo->culprits = culprits;
    end(servo);
}

/* A scale by which one can divide. */
static bool usable(double scale)
{
    double size = scale < 0 ? -scale : scale;
    return size > 1e-9 && size < 1e12;
}

static void begin(carrystep_servo *servo, const carrystep_servo_in *in)
{
    double most[CARRYSTEP_MOST_AXES];
    for (uint8_t axis = 0; axis < servo->axes; axis++) {
        double scale = in->scale[axis] < 0 ? -in->scale[axis] : in->scale[axis];
        double greatest = 0.499e9 / (double)servo->report.tick_ns;
        double own = in->most[axis] * scale;
        most[axis] = own > 0 && own < greatest ? own : greatest;
        servo->scale[axis] = in->scale[axis];
    }
    uint32_t stream = servo->streams + 1u != 0 ? servo->streams + 1u : 1u;
    if (!carrystep_blocks_begin(&servo->blocks, stream, servo->axes, servo->periods, (uint32_t)servo->period_ns,
                                servo->report.tick_ns, servo->at, most)) {
        fail(servo, CARRYSTEP_FAULT_PERIOD, 0);
        return;
    }
    memset(servo->glide, 0, sizeof servo->glide);
    servo->streams = stream;
    servo->stream = stream;
    __atomic_store_n(&servo->shared->made, (uint64_t)0, __ATOMIC_RELEASE);
    __atomic_store_n(&servo->shared->wanted, stream, __ATOMIC_RELEASE);
}

static uint32_t refusal(carrystep_taken taken)
{
    switch (taken) {
    case CARRYSTEP_NOT_A_NUMBER:
        return CARRYSTEP_FAULT_NOT_A_NUMBER;
    case CARRYSTEP_OUT_OF_RANGE:
        return CARRYSTEP_FAULT_OUT_OF_RANGE;
    case CARRYSTEP_JUMP:
        return CARRYSTEP_FAULT_JUMP;
    default:
        return CARRYSTEP_FAULT_TOO_FAST;
    }
}

/* What a segment says of the outputs. The engine takes a bit of one that it has not for a fault. */
static uint32_t outputs(const carrystep_servo *servo, const carrystep_servo_in *in)
{
    uint32_t word = servo->outputs != 0 ? CARRYSTEP_OUTPUTS(servo->outputs, in->levels & servo->outputs) : 0u;
    if (servo->pwm) {
        /* A duty that is no finite number is 0. */
        double duty = in->duty > 0.0 && in->duty < 1e300 ? in->duty : 0.0;
        double part = duty < 1.0 ? duty * 4096.0 : 4095.0;
        word |= CARRYSTEP_DUTY(part < 4095.0 ? (uint32_t)part : 4095u);
    }
    return word;
}

/* Takes the commands of this period into the stream that runs. */
static void follow(carrystep_servo *servo, const carrystep_servo_in *in)
{
    double steps[CARRYSTEP_MOST_AXES];
    carrystep_block block;
    for (uint8_t axis = 0; axis < servo->axes; axis++) {
        steps[axis] = carrystep_glide_take(&servo->glide[axis], in->command[axis] * servo->scale[axis],
                                           servo->blocks.axis[axis].latest, servo->blocks.axis[axis].previous,
                                           servo->blocks.axis[axis].most, servo->blocks.period_ns);
        /* The bits are compared: a scale that is not a number differs from itself. */
        if (memcmp(&in->scale[axis], &servo->scale[axis], sizeof servo->scale[axis]) != 0) {
            fail(servo, CARRYSTEP_FAULT_SCALE, (uint8_t)(1u << axis));
            return;
        }
    }
    int32_t trim = __atomic_load_n(&servo->shared->trim, __ATOMIC_ACQUIRE);
    carrystep_taken taken = carrystep_blocks_take(&servo->blocks, steps, outputs(servo, in), trim, &block);
    if (taken == CARRYSTEP_A_BLOCK) {
        if (!carrystep_ring_put(&servo->shared->blocks, &block)) {
            fail(servo, CARRYSTEP_FAULT_LATE, 0);
            return;
        }
        __atomic_store_n(&servo->shared->made, servo->blocks.ticks, __ATOMIC_RELEASE);
    } else if (taken != CARRYSTEP_NO_BLOCK) {
        fail(servo, refusal(taken), (uint8_t)(1u << servo->blocks.culprit));
    }
}

/* Decides whether a stream begins, goes on or ends. */
static void decide(carrystep_servo *servo, long period_ns, const carrystep_servo_in *in)
{
    bool scales = true;
    for (uint8_t axis = 0; axis < servo->axes; axis++) {
        scales = scales && usable(in->scale[axis]);
    }
    if (servo->period_ns == 0) {
        servo->period_ns = period_ns;
    }
    if (!in->enable) {
        end(servo);
        if (servo->report.state == CARRYSTEP_READY && servo->report.fault == 0) {
            servo->fault = 0;
            servo->culprits = 0;
            servo->period_ns = period_ns;
        }
    } else if (servo->fault != 0) {
        end(servo);
    } else if (servo->report.fault != 0) {
        fail(servo, servo->report.fault, servo->report.culprits);
    } else if (period_ns != servo->period_ns || period_ns <= 0 || period_ns > 1000000000L) {
        fail(servo, CARRYSTEP_FAULT_PERIOD, 0);
    } else if (!scales) {
        fail(servo, CARRYSTEP_FAULT_SCALE, 0);
    } else if (servo->stream == 0 && servo->report.state != CARRYSTEP_READY) {
        fail(servo, CARRYSTEP_FAULT_NOT_READY, 0);
    } else {
        if (servo->stream == 0) {
            begin(servo, in);
        }
        if (servo->stream != 0) {
            follow(servo, in);
        }
    }
}

/* Takes a report that follows `before`: which joints' feedback is a place of the board now. */
static void look(carrystep_servo *servo, uint32_t before, const carrystep_servo_in *in)
{
    const carrystep_report *report = &servo->report;
    uint32_t changed = before ^ report->inputs;
    uint32_t joints = 0;
    const carrystep_place *at = report->at;
    if (report->latched == CARRYSTEP_LATCHED_INDEX) {
        joints = servo->index;
        at = report->latched_at;
        servo->moment.found = servo->index;
        servo->index = 0;
    } else if ((changed >> 16 & 1u) != 0) {
        joints = 0xff;
        at = report->latched == CARRYSTEP_LATCHED_PROBE ? report->latched_at : report->at;
    } else if (changed != 0) {
        joints = in->homing;
    }
    for (uint8_t axis = 0; axis < servo->axes; axis++) {
        /* Of several reports in a period the first counts, but a latch before a snapshot. */
        bool counts = (servo->moment.joints >> axis & 1u) == 0 || at == report->latched_at;
        if ((joints >> axis & 1u) != 0 && counts) {
            servo->moment.joints |= 1u << axis;
            servo->moment.at[axis] = at[axis];
        }
    }
}

void carrystep_servo_run(carrystep_servo *servo, long period_ns, const carrystep_servo_in *in, carrystep_servo_out *out)
{
    uint32_t before = servo->report.inputs;
    servo->moment.joints = 0;
    servo->moment.found = 0;
    servo->index = servo->stream != 0 ? in->index : 0;
    while (carrystep_ring_take(&servo->shared->reports, &servo->report)) {
        look(servo, before, in);
        before = servo->report.inputs;
        /* A board that has gone leaves the place where it was seen last. */
        if (servo->report.placed) {
            memcpy(servo->at, servo->report.at, sizeof servo->at);
        }
    }
    decide(servo, period_ns, in);
    __atomic_store_n(&servo->shared->index, (uint32_t)servo->index, __ATOMIC_RELEASE);
    out->index = (uint8_t)(in->index & ~(unsigned)servo->moment.found);
    uint32_t code = servo->fault != 0 ? servo->fault : servo->report.fault;
    bool away = servo->stream == 0 && servo->report.state != CARRYSTEP_READY;
    out->fault_code = code;
    out->fault = code != 0 || away;
    out->culprits = servo->fault != 0 ? servo->culprits : servo->report.culprits;
    out->running = servo->stream != 0;
    for (uint8_t axis = 0; axis < servo->axes; axis++) {
        if (servo->stream != 0) {
            bool known = servo->report.stream == servo->stream;
            double off = servo->glide[axis].rest + (known ? servo->report.error[axis] : 0.0);
            if (((unsigned)servo->moment.found >> axis & 1u) != 0) {
                carrystep_glide_show(&servo->glide[axis], carrystep_steps_of(servo->moment.at[axis]));
            }
            if ((servo->moment.joints >> axis & 1u) != 0) {
                out->feedback[axis] = carrystep_steps_of(servo->moment.at[axis]) / servo->scale[axis];
                continue;
            }
            out->feedback[axis] = in->command[axis] + off / servo->scale[axis];
        } else if (usable(in->scale[axis])) {
            out->feedback[axis] = carrystep_steps_of(servo->at[axis]) / in->scale[axis];
        }
    }
}

/* See carrystep_pump.h. */
#include "carrystep_pump.h"

#include <string.h>

#define MS UINT64_C(1000)
#define RESEND_MS 40u
#define PAUSE_MS 2u
#define SILENCE (2000u * MS) /* without an answer for this time, the board is gone */
#define SILENCE_IN_MOTION (500u * MS)
#define LOOK (10u * MS)      /* between snapshots */
#define POLL (5u * MS)       /* between reads while something is waited for */
#define CLEAR (20u * MS)     /* between tries to clear a stop */

void carrystep_pump_away(carrystep_shared *shared, uint32_t fault)
{
    carrystep_report report;
    memset(&report, 0, sizeof report);
    report.state = CARRYSTEP_AWAY;
    report.fault = fault;
    carrystep_ring_put(&shared->reports, &report);
}

static void tell(carrystep_pump *pump)
{
    static const carrystep_state STATES[] = {CARRYSTEP_AWAY,  CARRYSTEP_AWAY,     CARRYSTEP_ENDING,  CARRYSTEP_ENDING,
                                             CARRYSTEP_READY, CARRYSTEP_POWERING, CARRYSTEP_RUNNING, CARRYSTEP_AWAY};
    pump->report.state = STATES[pump->state];
    /* If the queue is full, the real-time function does not run; a later report tells the same. */
    if (carrystep_ring_put(&pump->shared->reports, &pump->report)) {
        pump->report.latched = CARRYSTEP_LATCHED_NOTHING;
    }
}

static void enter(carrystep_pump *pump, carrystep_pump_state state)
{
    pump->state = state;
    pump->since = pump->now;
    pump->polled = 0;
    pump->fresh = false;
    pump->stopped = false;
    pump->clearing = false;
    tell(pump);
}

static void fail(carrystep_pump *pump, uint32_t fault, uint8_t culprits)
{
    pump->report.fault = fault;
    pump->report.culprits = culprits;
    pump->report.stream = 0;
}

static void gone(carrystep_pump *pump, uint32_t fault)
{
    fail(pump, fault, 0);
    enter(pump, CARRYSTEP_PUMP_GONE);
}

static void stop(carrystep_pump *pump)
{
    pump->report.stream = 0;
    pump->stream = 0;
    enter(pump, CARRYSTEP_PUMP_STOPPING);
}

void carrystep_pump_begin(carrystep_pump *pump, carrystep_shared *shared, const carrystep_pump_how *how,
                          uint64_t now_us)
{
    memset(pump, 0, sizeof *pump);
    pump->shared = shared;
    pump->how = *how;
    pump->now = now_us;
    pump->heard = now_us;
    pump->look.axes = how->axes;
    pump->look.latched = how->probe_latch != CARRYSTEP_NO_LATCH || how->index_latch != CARRYSTEP_NO_LATCH;
    carrystep_latches_begin(&pump->latches, how->probe_latch, how->index_latch);
    carrystep_begin(&pump->session, RESEND_MS, PAUSE_MS);
    if (how->window != 0) {
        carrystep_limit(&pump->session, how->window);
    }
    enter(pump, CARRYSTEP_PUMP_ASKING);
}

static uint32_t milliseconds(uint64_t us)
{
    return (uint32_t)(us / MS);
}

static uint32_t wanted(const carrystep_pump *pump)
{
    return __atomic_load_n(&pump->shared->wanted, __ATOMIC_ACQUIRE);
}

static uint8_t mask(const carrystep_pump *pump)
{
    return (uint8_t)((1u << pump->how.axes) - 1u);
}

/* ---- snapshots ---- */

/* Begins a snapshot when it is time. */
static void begin_snapshot(carrystep_pump *pump)
{
    if (pump->now - pump->look.begun >= LOOK) {
        carrystep_look_begin(&pump->look, &pump->session, pump->now, pump->sent.sent);
    }
}

/* Compares the clocks, and trims the segments to the board's. */
static void trim(carrystep_pump *pump, int64_t lead)
{
    int64_t faster = 0, bound = 0;
    if (!carrystep_clock_difference(&pump->clocks, &faster, &bound) || bound > 1000000) {
        faster = 0;
    }
    pump->report.trim = carrystep_trim_take(&pump->trim, lead, faster);
    pump->report.lead_ns = lead * (int64_t)pump->report.tick_ns;
    __atomic_store_n(&pump->shared->trim, pump->report.trim, __ATOMIC_RELEASE);
}

static void finish_snapshot(carrystep_pump *pump)
{
    int64_t tick = carrystep_tick(&pump->ticks, pump->look.ticks);
    bool running = pump->state == CARRYSTEP_PUMP_RUNNING && pump->look.count > 0;
    bool all;
    carrystep_places places;
    carrystep_observe(&pump->clocks, tick, pump->look.before, pump->look.after);
    all = carrystep_measure(&pump->sent, running ? pump->look.count : 0, pump->facts.depth + 1u, pump->how.axes,
                            pump->look.seen, &places);
    memcpy(pump->report.at, places.at, sizeof places.at);
    pump->report.placed = true;
    if (running) {
        memcpy(pump->report.error, places.error, sizeof places.error);
    }
    if (running && places.lost != 0) {
        fail(pump, CARRYSTEP_FAULT_LOST, places.lost);
    }
    if (all) {
        pump->report.stream = pump->report.fault == 0 ? pump->stream : 0;
        pump->report.reserve_ns = (int64_t)(places.reserve * pump->report.tick_ns);
        trim(pump, (int64_t)(pump->made + pump->rest) - (int64_t)places.gone_by);
    }
    bool wants = __atomic_load_n(&pump->shared->index, __ATOMIC_ACQUIRE) != 0;
    carrystep_latches_take(&pump->latches, &pump->look, &pump->session, wants);
    pump->report.inputs = carrystep_latches_inputs(&pump->latches, &pump->look);
    if (pump->state == CARRYSTEP_PUMP_LOOKING) {
        pump->report.fault = 0;
        pump->report.culprits = 0;
        enter(pump, CARRYSTEP_PUMP_IDLE);
    } else {
        tell(pump);
    }
}

/* The place of the edge that a latch has found. */
static void finish_record(carrystep_pump *pump)
{
    carrystep_record record = carrystep_latches_record(&pump->latches);
    if (record == CARRYSTEP_RECORD_NONE) {
        return;
    }
    pump->report.latched = record == CARRYSTEP_RECORD_PROBE ? CARRYSTEP_LATCHED_PROBE : CARRYSTEP_LATCHED_INDEX;
    for (uint8_t axis = 0; axis < pump->how.axes; axis++) {
        pump->report.latched_at[axis] = carrystep_actual(&pump->look.record[axis]);
    }
    pump->report.inputs = carrystep_latches_inputs(&pump->latches, &pump->look);
    tell(pump);
}

static void take_answer(carrystep_pump *pump, const carrystep_answer *answer)
{
    bool waits = pump->look.stage == CARRYSTEP_LOOK_WRITTEN;
    carrystep_look_event event = carrystep_look_take(&pump->look, &pump->session, pump->now, answer);
    if (waits && pump->look.stage != CARRYSTEP_LOOK_WRITTEN) {
        pump->made = __atomic_load_n(&pump->shared->made, __ATOMIC_ACQUIRE);
    }
    switch (event) {
    case CARRYSTEP_LOOK_SNAPSHOT:
        finish_snapshot(pump);
        break;
    case CARRYSTEP_LOOK_RECORD:
        finish_record(pump);
        break;
    case CARRYSTEP_LOOK_NOTHING:
        break;
    }
}

/* ---- the states ---- */

/* Reads the position of axis 0 from time to time, for the flags of the answer. */
static void poll(carrystep_pump *pump)
{
    if (pump->now - pump->polled >= POLL && carrystep_read(&pump->session, CARRYSTEP_POSITION)) {
        pump->polled = pump->now;
    }
}

static void ask(carrystep_pump *pump)
{
    bool all = carrystep_facts_ask(&pump->facts, &pump->session, pump->fresh ? &pump->answer : NULL);
    pump->fresh = false;
    if (!all) {
        return;
    }
    if (!carrystep_facts_fit(&pump->facts, pump->how.axes, pump->how.build)) {
        gone(pump, CARRYSTEP_FAULT_OTHER_BOARD);
        return;
    }
    pump->report.tick_ns = pump->facts.tick_ns;
    carrystep_compare(&pump->clocks, pump->report.tick_ns);
    carrystep_trim_begin(&pump->trim, (int64_t)(pump->how.horizon_ns / pump->report.tick_ns));
    enter(pump, CARRYSTEP_PUMP_OPENING);
}

static void open_session(carrystep_pump *pump)
{
    if (carrystep_owns(&pump->session)) {
        stop(pump);
    } else if (!carrystep_opening(&pump->session) && pump->now - pump->polled >= POLL) {
        pump->polled = pump->now;
        carrystep_open(&pump->session, pump->how.number, (uint8_t)pump->facts.axes);
    }
}

static void stopping(carrystep_pump *pump)
{
    if (!pump->stopped) {
        pump->stopped = true;
        carrystep_stop(&pump->session);
        pump->fresh = false;
    } else if (carrystep_stopping(&pump->session) || carrystep_writing(&pump->session)) {
        return;
    } else if (pump->clearing && pump->fresh && !pump->answer.fault) {
        memset(&pump->sent, 0, sizeof pump->sent);
        pump->look.stage = CARRYSTEP_LOOK_NONE;
        carrystep_write(&pump->session, CARRYSTEP_CONTROL, 0);
        enter(pump, CARRYSTEP_PUMP_LOOKING);
    } else if (pump->fresh && pump->answer.halted && pump->now - pump->cleared >= CLEAR) {
        /* The cause may go on, as a pressed e-stop does: then CLEAR has no effect, and is repeated. */
        pump->cleared = pump->now;
        pump->clearing = carrystep_write(&pump->session, CARRYSTEP_CLEAR, 1);
        pump->fresh = false;
    } else {
        poll(pump);
    }
}

static void idle(carrystep_pump *pump)
{
    carrystep_block stale;
    uint32_t stream = wanted(pump);
    if (pump->fresh && pump->answer.fault) {
        fail(pump, CARRYSTEP_FAULT_STOP + pump->answer.cause, pump->answer.culprits);
        stop(pump);
        return;
    }
    begin_snapshot(pump);
    while (carrystep_ring_peek(&pump->shared->blocks, &stale) && stale.stream != stream) {
        carrystep_ring_take(&pump->shared->blocks, &stale);
    }
    if (stream != 0 && carrystep_write(&pump->session, CARRYSTEP_CONTROL, CARRYSTEP_CONTROL_ENABLE)) {
        pump->stream = stream;
        enter(pump, CARRYSTEP_PUMP_POWERING);
    }
}

/* Sends a block to all axes. False if there is no room. */
static bool send(carrystep_pump *pump, const carrystep_block *block)
{
    carrystep_session *session = &pump->session;
    if ((unsigned)session->length + pump->how.axes >= CARRYSTEP_SLOTS) {
        return false;
    }
    for (uint8_t axis = 0; axis < pump->how.axes; axis++) {
        if (session->room[axis] == 0) {
            return false;
        }
    }
    for (uint8_t axis = 0; axis < pump->how.axes; axis++) {
        if (!carrystep_put(session, axis, &block->axes[axis])) {
            return false;
        }
    }
    carrystep_remember(&pump->sent, block);
    return true;
}

/* Begins a stream with a segment of rest that makes the lead equal to the horizon. */
static void powering(carrystep_pump *pump)
{
    carrystep_block first, rest;
    if (wanted(pump) != pump->stream) {
        stop(pump);
        return;
    }
    if (!pump->fresh || !pump->answer.ready || carrystep_writing(&pump->session)) {
        poll(pump);
        return;
    }
    if (!carrystep_ring_peek(&pump->shared->blocks, &first)) {
        begin_snapshot(pump);
        return;
    }
    uint64_t made = __atomic_load_n(&pump->shared->made, __ATOMIC_ACQUIRE);
    uint64_t horizon = (uint64_t)pump->trim.horizon;
    pump->rest = horizon > made + 1u ? horizon - made : 1u;
    pump->report.rest = pump->rest;
    memset(&rest, 0, sizeof rest);
    for (uint8_t axis = 0; axis < pump->how.axes; axis++) {
        rest.at[axis] = first.at[axis];
        rest.axes[axis].ticks = (uint32_t)pump->rest;
    }
    if (!send(pump, &rest)) {
        begin_snapshot(pump);
        return;
    }
    carrystep_write(&pump->session, CARRYSTEP_START, mask(pump));
    enter(pump, CARRYSTEP_PUMP_RUNNING);
}

static void running(carrystep_pump *pump)
{
    carrystep_block block;
    if (wanted(pump) != pump->stream) {
        stop(pump);
        return;
    }
    if (pump->report.fault != 0) {
        return; /* until the real-time function has seen it, and wants no stream any more */
    }
    while (carrystep_ring_peek(&pump->shared->blocks, &block)) {
        if (block.stream == pump->stream) {
            block.before += pump->rest;
            if (!send(pump, &block)) {
                break;
            }
        }
        carrystep_ring_take(&pump->shared->blocks, &block);
    }
    begin_snapshot(pump);
}

void carrystep_pump_run(carrystep_pump *pump, uint64_t now_us)
{
    pump->now = now_us;
    if (pump->state == CARRYSTEP_PUMP_GONE) {
        return;
    }
    if (now_us - pump->heard > (pump->state == CARRYSTEP_PUMP_RUNNING ? SILENCE_IN_MOTION : SILENCE)) {
        gone(pump, CARRYSTEP_FAULT_NO_ANSWER);
        return;
    }
    switch (pump->state) {
    case CARRYSTEP_PUMP_ASKING:
        ask(pump);
        break;
    case CARRYSTEP_PUMP_OPENING:
        open_session(pump);
        break;
    case CARRYSTEP_PUMP_STOPPING:
        begin_snapshot(pump);
        stopping(pump);
        break;
    case CARRYSTEP_PUMP_LOOKING:
        begin_snapshot(pump);
        break;
    case CARRYSTEP_PUMP_IDLE:
        idle(pump);
        break;
    case CARRYSTEP_PUMP_POWERING:
        powering(pump);
        break;
    case CARRYSTEP_PUMP_RUNNING:
        running(pump);
        break;
    case CARRYSTEP_PUMP_GONE:
        break;
    }
    carrystep_look_read(&pump->look, &pump->session);
}

size_t carrystep_pump_transmit(carrystep_pump *pump, uint64_t now_us, uint8_t *line)
{
    pump->now = now_us;
    return pump->state == CARRYSTEP_PUMP_GONE ? 0 : carrystep_transmit(&pump->session, milliseconds(now_us), line);
}

void carrystep_pump_receive(carrystep_pump *pump, uint64_t now_us, uint8_t byte)
{
    carrystep_answer answer;
    pump->now = now_us;
    carrystep_event event = carrystep_receive(&pump->session, byte, milliseconds(now_us), &answer);
    if (event == CARRYSTEP_LOST) {
        gone(pump, CARRYSTEP_FAULT_SESSION);
    }
    if (event != CARRYSTEP_HEARD || pump->state == CARRYSTEP_PUMP_GONE) {
        return;
    }
    pump->heard = now_us;
    pump->answer = answer;
    pump->fresh = true;
    if (answer.fault && pump->report.fault == 0 &&
        (pump->state == CARRYSTEP_PUMP_RUNNING || pump->state == CARRYSTEP_PUMP_POWERING)) {
        fail(pump, CARRYSTEP_FAULT_STOP + answer.cause, answer.culprits);
        tell(pump);
    }
    take_answer(pump, &answer);
}

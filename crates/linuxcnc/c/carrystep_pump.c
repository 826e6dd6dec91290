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
#define A_STEP ((carrystep_place)1 << 64)

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
    carrystep_ring_put(&pump->shared->reports, &pump->report);
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
    carrystep_begin(&pump->session, RESEND_MS, PAUSE_MS);
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

static const uint8_t OF_AXIS[] = {CARRYSTEP_SNAPSHOT_P_HIGH, CARRYSTEP_SNAPSHOT_POSITION, CARRYSTEP_SNAPSHOT_STATUS,
                                  CARRYSTEP_SNAPSHOT_LEFT};
#define ALONE 2u /* registers that are read once: TICKS, INPUTS */

/* The register with this number in the set of those that a snapshot reads. */
static uint8_t snapshot_register(uint32_t number)
{
    if (number < ALONE) {
        return number == 0 ? CARRYSTEP_SNAPSHOT_TICKS : CARRYSTEP_INPUTS;
    }
    number -= ALONE;
    return (uint8_t)CARRYSTEP_OF_AXIS(OF_AXIS[number % 4u], number / 4u);
}

static uint32_t registers(const carrystep_pump *pump)
{
    return ALONE + 4u * pump->how.axes;
}

/* Begins a snapshot, but never before the last one is complete: its reads and those of the next
 * have the same addresses, and a mixture of both would be a place where no axis ever was. */
static void begin_snapshot(carrystep_pump *pump)
{
    if (pump->snapshot.stage == 0 && pump->now - pump->looked >= LOOK && carrystep_write(&pump->session, CARRYSTEP_SNAPSHOT, 1)) {
        pump->snapshot.stage = 1;
        pump->snapshot.count = pump->sent.sent;
        pump->snapshot.before = pump->now;
        pump->looked = pump->now;
    }
}

/* Whether the write of SNAPSHOT is acknowledged. Any answer may do that, if its own was lost. */
static bool snapshot_is_taken(const carrystep_session *session)
{
    for (unsigned index = 0; index < session->length; index++) {
        unsigned slot = (session->at + index) % CARRYSTEP_SLOTS;
        if (session->slots[slot].address == (CARRYSTEP_WRITE | CARRYSTEP_SNAPSHOT)) {
            return false;
        }
    }
    return true;
}

static void read_snapshot(carrystep_pump *pump)
{
    for (uint32_t number = 0; pump->snapshot.stage == 2 && number < registers(pump); number++) {
        if ((pump->snapshot.missing >> number & 1u) != 0 &&
            !carrystep_read(&pump->session, snapshot_register(number))) {
            return;
        }
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
    int64_t tick = carrystep_tick(&pump->ticks, pump->snapshot.ticks);
    bool running = pump->state == CARRYSTEP_PUMP_RUNNING && pump->snapshot.count > 0;
    bool all = running;
    uint64_t gone_by = 0;
    pump->snapshot.stage = 0;
    carrystep_observe(&pump->clocks, tick, pump->snapshot.before, pump->snapshot.after);
    for (uint8_t axis = 0; axis < pump->how.axes; axis++) {
        const carrystep_seen *seen = &pump->snapshot.seen[axis];
        carrystep_place planned, actual = carrystep_actual(seen);
        pump->report.at[axis] = actual;
        pump->report.placed = true;
        if (!running) {
            continue;
        }
        if (!carrystep_commanded(&pump->sent, pump->snapshot.count, pump->depth + 1u, axis, seen, &planned,
                                 &gone_by)) {
            all = false; /* the start has not been executed yet, or the axes have stopped */
            continue;
        }
        carrystep_place error = actual - planned;
        pump->report.error[axis] = carrystep_steps_of(error);
        if (error >= A_STEP || error <= -A_STEP) {
            fail(pump, CARRYSTEP_FAULT_LOST, (uint8_t)(1u << axis));
        }
    }
    if (all) {
        const carrystep_block *last = &pump->sent.blocks[(pump->snapshot.count - 1u) % CARRYSTEP_REMEMBERED];
        uint64_t reserve = last->before + last->axes[0].ticks - gone_by;
        pump->report.stream = pump->stream;
        pump->report.reserve_ns = (int64_t)(reserve * pump->report.tick_ns);
        trim(pump, (int64_t)(pump->snapshot.made + pump->rest) - (int64_t)gone_by);
    }
    if (pump->state == CARRYSTEP_PUMP_LOOKING) {
        pump->report.fault = 0;
        pump->report.culprits = 0;
        enter(pump, CARRYSTEP_PUMP_IDLE);
    } else {
        tell(pump);
    }
}

static void take_snapshot(carrystep_pump *pump, const carrystep_answer *answer)
{
    if (pump->snapshot.stage == 1 && snapshot_is_taken(&pump->session)) {
        pump->snapshot.stage = 2;
        pump->snapshot.after = pump->now;
        pump->snapshot.made = __atomic_load_n(&pump->shared->made, __ATOMIC_ACQUIRE);
        pump->snapshot.missing = ((uint64_t)1 << registers(pump)) - 1u;
    }
    if (pump->snapshot.stage != 2 || answer->written) {
        return;
    }
    for (uint32_t number = 0; number < registers(pump); number++) {
        if ((pump->snapshot.missing >> number & 1u) == 0 || snapshot_register(number) != answer->address) {
            continue;
        }
        pump->snapshot.missing &= ~((uint64_t)1 << number);
        if (number == 0) {
            pump->snapshot.ticks = answer->data;
        } else if (number == 1) {
            pump->report.inputs = answer->data;
        } else {
            carrystep_seen *seen = &pump->snapshot.seen[(number - ALONE) / 4u];
            uint32_t *words[] = {&seen->p_high, &seen->position, &seen->status, &seen->left};
            *words[(number - ALONE) % 4u] = answer->data;
        }
        if (pump->snapshot.missing == 0) {
            finish_snapshot(pump);
        }
        return;
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
    static const uint8_t FACTS[] = {CARRYSTEP_IDENTITY, CARRYSTEP_PROTOCOL, CARRYSTEP_BUILD_LOW, CARRYSTEP_BUILD_HIGH,
                                    CARRYSTEP_AXIS_COUNT, CARRYSTEP_TICK_NS, CARRYSTEP_QUEUE_DEPTH};
    if (pump->fact < sizeof FACTS) {
        if (pump->fresh && !pump->answer.written && pump->answer.address == FACTS[pump->fact]) {
            pump->facts[pump->fact] = pump->answer.data;
            pump->fact++;
            pump->fresh = false;
        }
        if (pump->fact < sizeof FACTS) {
            carrystep_read(&pump->session, FACTS[pump->fact]);
            return;
        }
    }
    uint64_t build = (uint64_t)pump->facts[3] << 32 | pump->facts[2];
    uint64_t required = pump->how.build != 0 ? pump->how.build : build;
    uint32_t axes = pump->facts[4];
    pump->report.tick_ns = pump->facts[5];
    pump->depth = pump->facts[6];
    if (carrystep_check(pump->facts[0], pump->facts[1], build, required) != CARRYSTEP_FINE ||
        axes < pump->how.axes || axes > CARRYSTEP_MOST_AXES || pump->report.tick_ns == 0 ||
        pump->depth < CARRYSTEP_LEAST_QUEUE || pump->depth > 31u) {
        gone(pump, CARRYSTEP_FAULT_OTHER_BOARD);
        return;
    }
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
        carrystep_open(&pump->session, pump->how.number, (uint8_t)pump->facts[4]);
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
        pump->snapshot.stage = 0;
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
    read_snapshot(pump);
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
    take_snapshot(pump, &answer);
}

/* What the real-time function does in each servo period: takes commands, makes blocks, and says
 * where the axes are. It never waits. The other thread (carrystep_pump.h) talks with the board.
 *
 * LinuxCNC takes the place of a probe, an index pulse or a home switch from the feedback of the
 * period in which it sees the input. The pulses are a horizon behind the command by then, so in this
 * one period the feedback is the place where the board was: that of the latch, or that of the
 * snapshot which shows the input first. In all others it is the command and the error. LinuxCNC's
 * command jumps to the place of an index pulse: carrystep_glide.h says how the axis gets there.
 *
 * Nothing here knows HAL, so that tests call it as HAL does. */
#ifndef CARRYSTEP_SERVO_H
#define CARRYSTEP_SERVO_H

#include "carrystep_blocks.h"
#include "carrystep_glide.h"
#include "carrystep_ring.h"

/* Blocks that can wait for the thread, and reports that can wait for the real-time function. */
#define CARRYSTEP_BLOCK_CELLS 128u
#define CARRYSTEP_REPORT_CELLS 64u

/* Why the joints are disabled, as the pin fault-code shows it. */
typedef enum {
    CARRYSTEP_FAULT_NONE = 0,
    CARRYSTEP_FAULT_NO_PORT = 1,       /* the port cannot be opened */
    CARRYSTEP_FAULT_PORT_BUSY = 2,     /* another program has the port */
    CARRYSTEP_FAULT_NO_ANSWER = 3,     /* nothing answers at the port, or not any more */
    CARRYSTEP_FAULT_OTHER_BOARD = 4,   /* another device, protocol, build or number of axes */
    CARRYSTEP_FAULT_SESSION = 5,       /* another program has taken the board, or it was restarted */
    CARRYSTEP_FAULT_NOT_READY = 6,     /* enabled while the board was not ready */
    CARRYSTEP_FAULT_LATE = 7,          /* the thread takes no blocks any more */
    CARRYSTEP_FAULT_LOST = 8,          /* the engine is not where the segments led it */
    CARRYSTEP_FAULT_NOT_A_NUMBER = 9,  /* position-cmd is not a finite number */
    CARRYSTEP_FAULT_OUT_OF_RANGE = 10, /* position-cmd is 2^31 steps from zero, or further */
    CARRYSTEP_FAULT_JUMP = 11,         /* position-cmd is faster than maxvel */
    CARRYSTEP_FAULT_TOO_FAST = 12,     /* faster than the engine can step */
    CARRYSTEP_FAULT_PERIOD = 13,       /* the servo period has changed, or makes no block */
    CARRYSTEP_FAULT_SCALE = 14,        /* a scale is 0 or not finite, or has changed in motion */
    CARRYSTEP_FAULT_STOP = 20          /* and more: 20 + CARRYSTEP_CAUSE_ of the board's stop */
} carrystep_fault;

/* One sentence for a fault, for messages. */
const char *carrystep_fault_text(uint32_t fault);

typedef enum {
    CARRYSTEP_AWAY,     /* no board, or not one of ours */
    CARRYSTEP_READY,    /* at rest, without power; a stream may begin */
    CARRYSTEP_POWERING, /* waits for the drivers' power and the first blocks */
    CARRYSTEP_RUNNING,  /* a stream runs */
    CARRYSTEP_ENDING    /* the axes ramp down, and the stop is cleared */
} carrystep_state;

/* Of what edge a report has the place. */
typedef enum { CARRYSTEP_LATCHED_NOTHING, CARRYSTEP_LATCHED_PROBE, CARRYSTEP_LATCHED_INDEX } carrystep_latched;

/* What the thread tells the real-time function. */
typedef struct {
    carrystep_state state;
    uint32_t fault;
    uint8_t culprits;     /* the axes that caused the fault, one bit each; 0: all */
    uint32_t stream;      /* to which `error` belongs, or 0 */
    uint32_t tick_ns;
    bool placed;          /* `at` is known, from a snapshot of this connection */
    carrystep_place at[CARRYSTEP_MOST_AXES]; /* of the latest snapshot */
    double error[CARRYSTEP_MOST_AXES];       /* steps: place less command at the latest snapshot */
    uint32_t inputs;      /* register INPUTS, the probe as carrystep_latches.h says */
    carrystep_latched latched;
    carrystep_place latched_at[CARRYSTEP_MOST_AXES]; /* in the tick of that edge */
    int64_t lead_ns;      /* from the engine's tick to the end of the last block made */
    int64_t reserve_ns;   /* from the engine's tick to the end of the last block that it has */
    int32_t trim;
    uint64_t rest;        /* ticks of rest before the first block of the stream */
} carrystep_report;

/* What both threads share. */
typedef struct {
    carrystep_ring blocks;  /* to the thread */
    carrystep_ring reports; /* to the real-time function */
    uint32_t wanted;        /* number of the stream that the board shall run, or 0; atomic */
    uint64_t made;          /* ticks of the blocks of this stream; atomic */
    int32_t trim;           /* parts per 10^9; atomic */
    uint32_t end;           /* the thread shall end; atomic */
    uint32_t index;         /* the joints that wait for an index pulse, one bit each; atomic */
    uint32_t pause_us;      /* longest time between two rounds of the thread; atomic */
    carrystep_block block_cells[CARRYSTEP_BLOCK_CELLS];
    carrystep_report report_cells[CARRYSTEP_REPORT_CELLS];
} carrystep_shared;

void carrystep_share(carrystep_shared *shared);

/* The real-time function's own state. */
typedef struct {
    carrystep_shared *shared;
    uint8_t axes;
    uint32_t periods;
    uint8_t outputs; /* that the build has, one bit each */
    bool pwm;        /* whether the build has one */
    long period_ns; /* of the first call; 0 before it */
    uint32_t stream; /* that runs, or 0 */
    uint32_t streams;
    uint32_t fault; /* latched until the joints are disabled and the board is ready */
    uint8_t culprits;
    carrystep_report report;
    carrystep_place at[CARRYSTEP_MOST_AXES]; /* the latest known places */
    struct {
        uint32_t joints;  /* whose feedback is `at` in this period, one bit each */
        uint8_t found;    /* whose index pulse was found, one bit each */
        carrystep_place at[CARRYSTEP_MOST_AXES];
    } moment;
    uint8_t index;        /* the joints that wait for an index pulse, one bit each */
    carrystep_blocks blocks;
    carrystep_glide glide[CARRYSTEP_MOST_AXES]; /* of the stream */
    double scale[CARRYSTEP_MOST_AXES]; /* of the stream */
} carrystep_servo;

typedef struct {
    bool enable;
    double command[CARRYSTEP_MOST_AXES]; /* units */
    double scale[CARRYSTEP_MOST_AXES];   /* steps per unit */
    double most[CARRYSTEP_MOST_AXES];    /* greatest speed, units/s; 0: what the engine can */
    uint8_t homing;                      /* the joints that home, one bit each */
    uint8_t index;                       /* the joints that wait for an index pulse, one bit each */
    uint8_t levels;                      /* of the outputs, one bit each */
    double duty;                         /* of the PWM, 0 to 1; beyond is taken for the nearest of both */
} carrystep_servo_in;

typedef struct {
    double feedback[CARRYSTEP_MOST_AXES]; /* units */
    bool fault; /* of all joints: none may move without the others */
    uint8_t culprits; /* the joints that caused it, one bit each; 0: none of them alone */
    uint32_t fault_code;
    bool running;
    uint8_t index; /* the joints that still wait for an index pulse, one bit each */
} carrystep_servo_out;

/* `axes` is 1 to CARRYSTEP_MOST_AXES, `periods` 1 to CARRYSTEP_MOST_PERIODS. A build that has
 * outputs: set `outputs` and `pwm` behind this call. */
void carrystep_servo_begin(carrystep_servo *servo, carrystep_shared *shared, uint8_t axes, uint32_t periods);

/* One servo period of `period_ns`. */
void carrystep_servo_run(carrystep_servo *servo, long period_ns, const carrystep_servo_in *in, carrystep_servo_out *out);

#endif

/* Plays a speed ramp from a table of timer compare values: up, cruise, down, stop.
 *
 * A move of N steps has N delays, with a pulse at the end of each. Delay j (counted from 0) is that
 * of ramp pulse min(j, N - 1 - j), or that of the cruise if the ramp has fewer pulses. The first
 * entry is used, the way down is the way up in reverse, and a move shorter than two ramps changes
 * from up to down in its middle.
 *
 * The code is C99 without allocation, floating point and division. Each pulse takes a small and
 * bounded number of operations.
 *
 * Calling convention (AVR timer 1, CTC; `ramp` is the name of the generated header):
 *
 *     static carrystep_player player;
 *     static volatile uint8_t moving;
 *
 *     void move(uint32_t steps) {               // the timer is stopped, its interrupt off
 *         uint16_t compare;
 *         if (!carrystep_start(&player, &ramp_table, steps, &compare)) return;   // 0 steps
 *         moving = 1;
 *         TCNT1 = 0;
 *         OCR1A = compare;                      // the first delay
 *         TIFR1 = _BV(OCF1A);                   // clear an old match
 *         TIMSK1 |= _BV(OCIE1A);
 *         TCCR1B = _BV(WGM12) | _BV(CS11) | _BV(CS10);    // CTC, clock / 64
 *     }
 *
 *     ISR(TIMER1_COMPA_vect) {
 *         uint16_t compare;
 *         STEP_PORT |= STEP;                    // emit the pulse that is due
 *         if (carrystep_next(&player, &compare)) {
 *             OCR1A = compare;                  // the next delay
 *         } else {
 *             TIMSK1 &= ~_BV(OCIE1A);           // that was the last pulse
 *             moving = 0;
 *         }
 *         STEP_PORT &= ~STEP;                   // keep the driver's least pulse width
 *     }
 *
 * With a free-running timer, start with `OCR1A = TCNT1 + compare` and continue with
 * `OCR1A += compare`.
 *
 * In CTC mode the timer is already counting again when the handler runs. The shortest delay must be
 * longer than the handler and everything that may delay it. Otherwise the match is missed and the
 * timer counts through its whole range. With `interrupt_clocks` in the request, the generator
 * checks this.
 *
 * If the table is in program memory (PROGMEM), compile all files with -DCARRYSTEP_PROGMEM.
 */
#ifndef CARRYSTEP_PLAYER_H
#define CARRYSTEP_PLAYER_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CARRYSTEP_PLAYER_VERSION 1

/* A run of entries that all last the same number of pulses. */
typedef struct {
    uint16_t end;    /* index of the first entry after the run */
    uint16_t pulses; /* pulses of each entry of the run, 1 or more */
} carrystep_group;

/* A ramp, as the generated header defines it. */
typedef struct {
    const uint16_t *compare;       /* compare values, one per entry, from slow to fast */
    const carrystep_group *groups; /* in order; the last one ends with the table */
    uint32_t ramp;                 /* number of pulses over all entries */
    uint16_t cruise;               /* compare value of the top speed */
} carrystep_table;

/* The state of a move. Only the player may change the fields. */
typedef struct {
    const carrystep_table *table;
    uint32_t left;  /* pulses that are left, with the one whose delay runs */
    uint32_t at;    /* place: ramp pulse whose delay runs, 0 to table->ramp (cruise) */
    uint16_t entry; /* the same place as an entry, */
    uint16_t pulse; /* a pulse within the entry, */
    uint16_t group; /* and a group */
} carrystep_player;

/* Begins a move of `steps` steps. Returns true and writes the first delay to *compare; returns
 * false if `steps` is 0. */
bool carrystep_start(carrystep_player *player, const carrystep_table *table, uint32_t steps, uint16_t *compare);

/* Call this once per pulse, when its delay is over. Returns true and writes the next delay to
 * *compare; returns false after the last pulse: then stop the timer. */
bool carrystep_next(carrystep_player *player, uint16_t *compare);

/* Ends a move early: after the pulse whose delay runs, the move goes down the ramp. Call this with
 * the interrupt off. */
void carrystep_stop(carrystep_player *player);

/* Returns the number of pulses that are left. Call this with the interrupt off. */
uint32_t carrystep_left(const carrystep_player *player);

#ifdef __cplusplus
}
#endif

#endif

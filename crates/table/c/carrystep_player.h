/* Plays a speed ramp from a table of timer compare values: up, cruise, down, stop.
 *
 * A move of N steps has N delays, and a pulse at the end of each. Delay j (from 0) is that of ramp
 * pulse min(j, N - 1 - j), or the cruise where the ramp is over: the first entry is used, the way down
 * is the way up mirrored, and a move shorter than two ramps turns round half-way.
 *
 * C99, no allocation, no floating point, no division; a bounded handful of operations a pulse.
 *
 * Calling convention (AVR timer 1, CTC; `ramp` is the generated header's name):
 *
 *     static carrystep_player player;
 *     static volatile uint8_t moving;
 *
 *     void move(uint32_t steps) {               // the timer stands, its interrupt is off
 *         uint16_t compare;
 *         if (!carrystep_start(&player, &ramp_table, steps, &compare)) return;   // 0 steps
 *         moving = 1;
 *         TCNT1 = 0;
 *         OCR1A = compare;                      // the first delay
 *         TIFR1 = _BV(OCF1A);                   // forget an old match
 *         TIMSK1 |= _BV(OCIE1A);
 *         TCCR1B = _BV(WGM12) | _BV(CS11) | _BV(CS10);    // CTC, clock / 64
 *     }
 *
 *     ISR(TIMER1_COMPA_vect) {
 *         uint16_t compare;
 *         STEP_PORT |= STEP;                    // the pulse that is due
 *         if (carrystep_next(&player, &compare)) {
 *             OCR1A = compare;                  // the next delay
 *         } else {
 *             TIMSK1 &= ~_BV(OCIE1A);           // that was the last one
 *             moving = 0;
 *         }
 *         STEP_PORT &= ~STEP;                   // mind the driver's least pulse width
 *     }
 *
 * Free-running: start with `OCR1A = TCNT1 + compare`, go on with `OCR1A += compare`.
 *
 * In CTC mode the timer has begun to count again when the handler runs: the shortest delay must be
 * longer than the handler and whatever may hold it up, or the match is missed and the timer runs
 * once round (`interrupt_clocks` in the request makes the generator check that).
 *
 * With the table in program memory (PROGMEM), compile all files with -DCARRYSTEP_PROGMEM.
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
    uint16_t end;    /* the first entry behind it */
    uint16_t pulses; /* of each of its entries, 1 or more */
} carrystep_group;

/* A ramp, as the generated header has it. */
typedef struct {
    const uint16_t *compare;       /* one per entry, from slow to fast */
    const carrystep_group *groups; /* in order, the last one ends with the table */
    uint32_t ramp;                 /* pulses over all entries */
    uint16_t cruise;               /* compare value of the top speed */
} carrystep_table;

/* Where a move is. All fields belong to the player. */
typedef struct {
    const carrystep_table *table;
    uint32_t left;  /* pulses still to come, the one being waited for included */
    uint32_t at;    /* ramp pulse whose delay runs, 0 to table->ramp; there it cruises */
    uint16_t entry; /* the same place as entry, ... */
    uint16_t pulse; /* ... pulse within it, ... */
    uint16_t group; /* ... and group */
} carrystep_player;

/* Begins a move. True: *compare is the first delay. False: nothing to do, 0 steps. */
bool carrystep_start(carrystep_player *player, const carrystep_table *table, uint32_t steps, uint16_t *compare);

/* To be called once a pulse, when its delay is over. True: *compare is the next delay. False: that was
 * the last pulse, stop the timer. */
bool carrystep_next(carrystep_player *player, uint16_t *compare);

/* Ends a move early, down the ramp: the pulse being waited for, then as many as it takes. With the interrupt off. */
void carrystep_stop(carrystep_player *player);

/* Pulses still to come. With the interrupt off. */
uint32_t carrystep_left(const carrystep_player *player);

#ifdef __cplusplus
}
#endif

#endif

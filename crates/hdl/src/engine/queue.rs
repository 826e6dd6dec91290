//! The segment queue of each axis, and the control word of the axis of the present time slot.
//!
//! An axis has eight slots in memory, each of which holds one segment. The running segment is in
//! slot `live`; its ticks, V and A serve as the registers of the axis. The segments up to `newest`
//! wait. The host writes the slot after `newest`.
//!
//! ```text
//! slot     | 0 | 1 | 2 | 3 | 4 | 5 | 6 | 7 |
//!                live  waits   ^   ^ newest + 1: the host writes it
//!                              '-- newest                           empty: newest == live
//! ```
//!
//! The control word of an axis is read at the beginning of its time slot and written back in the
//! last beat. Its fields, from the lowest bit:
//!
//! ```text
//! bits     0-2    3-5      6         7       8      9       10-12   13    14-20
//! field    live   newest   running   unfit   back   known   due     met   counts
//! ```
//!
//! `unfit` means that the next V does not fit in 64 bits. `back` and `known` belong to a ramp: its
//! first tick stores the sign of V in `back` and sets `known`. `due` is the number of the word that
//! the host must put next: the words of a segment come in order, and word 7 commits it. `met` means
//! that the axis has hit its own source, and that this tick outputs its state for that. `counts`
//! belongs to [`super::step_counts`]; the queue only keeps it.
//!
//! Cost: a memory of 8 words of 21 bits for the control words and one of 64 bits for the marks of
//! last segments. A transition to the next segment only increments `live`; no segment is copied.

use super::layout::{
    BEAT_FIRST, BEAT_LAST, CONTROL_BACK, CONTROL_COUNTS, CONTROL_DUE, CONTROL_KNOWN, CONTROL_LIVE,
    CONTROL_MET, CONTROL_NEWEST, CONTROL_RUNNING, CONTROL_UNFIT,
};
use crate::primitives::constant::Literal;
use crate::primitives::memory::Memory;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use rust_hdl::prelude::*;

/// The control words of all axes, and the update of the present one.
#[derive(LogicBlock, Default)]
pub struct Queue {
    /// The clock.
    pub clock: Input<Clock>,
    /// The beats of [`super::time_slot`]: bit i is asserted in beat i of a time slot.
    pub beat: Input<Word<17>>,
    /// The axis of the time slot.
    pub axis: Input<Word<3>>,
    /// The axis of the next clock.
    pub axis_next: Input<Word<3>>,
    /// The axis starts in this tick.
    pub starts: Input<Bit>,
    /// A stop is complete: no axis runs.
    pub halted: Input<Bit>,
    /// The axis ramps down.
    pub ramp: Input<Bit>,
    /// Removes all segments.
    pub clear: Input<Bit>,
    /// In beat 12: removes the waiting segments.
    pub empties: Input<Bit>,
    /// The engine accepts the host's word in this clock.
    pub take: Input<Bit>,
    /// The number of that word.
    pub put_word: Input<Word<3>>,
    /// The committed segment is the last of its move.
    pub last: Input<Bit>,
    /// The running segment ends with this tick.
    pub ended: Input<Bit>,
    /// V + A does not fit in 64 bits.
    pub overflow: Input<Bit>,
    /// V = -2^63.
    pub least: Input<Bit>,
    /// V + A and V have different signs.
    pub turned: Input<Bit>,
    /// V < 0.
    pub back: Input<Bit>,
    /// In beat 12: the next tick's words of the axis are those of its own hit.
    pub meets: Input<Bit>,
    /// In beat 12: what is kept in `counts` until the next time slot of the axis.
    pub next_counts: Input<Word<7>>,
    /// The slot of the running segment.
    pub live: Signal<Out, Word<3>>,
    /// The slot that the host writes.
    pub fresh: Signal<Out, Word<3>>,
    /// Fault: the word accepted in the clock before was not the one that was due.
    pub misplaced: Signal<Out, Bit>,
    /// From beat 1: no slot is free for the host.
    pub full: Signal<Out, Bit>,
    /// The number of segments for which the queue has space, 0 to 7.
    pub room: Signal<Out, Word<3>>,
    /// No segment waits.
    pub empty: Signal<Out, Bit>,
    /// The axis runs in this tick.
    pub running: Signal<Out, Bit>,
    /// The axis runs, and V is in range as far as is known before beat 12.
    pub sound: Signal<Out, Bit>,
    /// V changes by the stop acceleration in this tick.
    pub slows: Signal<Out, Bit>,
    /// The ramp began with V < 0, so that V increases.
    pub upward: Signal<Out, Bit>,
    /// V stays unchanged in this tick, the first of a ramp.
    pub steady: Signal<Out, Bit>,
    /// In beat 12: the axis runs and its V is in range.
    pub moves: Signal<Out, Bit>,
    /// In beat 12: the axis runs in the next tick too.
    pub goes_on: Signal<Out, Bit>,
    /// In beat 12: the next segment begins with the next tick.
    pub advances: Signal<Out, Bit>,
    /// In beat 12, fault: V is out of range.
    pub too_fast: Signal<Out, Bit>,
    /// In beat 12, fault: the segment ends, it is not the last of its move, and no segment waits.
    pub dry: Signal<Out, Bit>,
    /// The words of this tick are those of the axis' own hit.
    pub met: Signal<Out, Bit>,
    /// `next_counts` of the time slot before of this axis, at first 0.
    pub counts: Signal<Out, Word<7>>,
    control: Memory<3, 21>,
    lasts: Memory<6, 1>,
    word: Signal<Local, Word<21>>,
    old_live: Signal<Local, Word<3>>,
    live_now: Signal<Local, Word<3>>,
    newest: Signal<Local, Word<3>>,
    fresh_now: Signal<Local, Word<3>>,
    runs: Signal<Local, Bit>,
    fits: Signal<Local, Bit>,
    none: Signal<Local, Bit>,
    last_one: Signal<Local, Bit>,
    ramps: Signal<Local, Bit>,
    over: Signal<Local, Bit>,
    follows: Signal<Local, Bit>,
    stays: Signal<Local, Bit>,
    steps_on: Signal<Local, Bit>, // `advances`
    due: Signal<Local, Word<3>>,
    fits_in: Signal<Local, Bit>, // the accepted word is the one that is due
    filled: Register<Bit>,       // `full`, a clock later, so that no long path begins at the memory
    took: Register<Bit>,         // the word that is due was accepted in this time slot
    wrong: Register<Bit>,        // `misplaced`
    next_live: Signal<Local, Word<3>>,
    next_newest: Signal<Local, Word<3>>,
    next_running: Signal<Local, Word<21>>,
    next_unfit: Signal<Local, Word<21>>,
    next_known: Signal<Local, Word<21>>,
    next_back: Signal<Local, Word<21>>,
    next_due: Signal<Local, Word<3>>,
    next_met: Signal<Local, Word<21>>,
    one: Literal<3, 1>,
    zero: Literal<3, 0>,
    no: Literal<21, 0>,
    running_bit: Literal<21, { 1 << CONTROL_RUNNING }>,
    unfit_bit: Literal<21, { 1 << CONTROL_UNFIT }>,
    back_bit: Literal<21, { 1 << CONTROL_BACK }>,
    known_bit: Literal<21, { 1 << CONTROL_KNOWN }>,
    all: Literal<21, 0x1f_ffff>,
    met_bit: Literal<21, { 1 << CONTROL_MET }>,
    commit: Literal<3, 7>,
    set: Literal<1, 1>,
    unset: Literal<1, 0>,
    at_3: Literal<4, 3>,
    at_10: Literal<4, 10>,
    at_14: Literal<4, 14>,
}

impl Logic for Queue {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, filled, took, wrong);
        clock!(self, clock, control, lasts);

        // The control word of this time slot.
        self.word.next = self.control.read_data.val();
        self.old_live.next = self.word.val().get_bits::<3>(CONTROL_LIVE);
        self.newest.next = self.word.val().get_bits::<3>(CONTROL_NEWEST);
        self.live_now.next = self.old_live.val();
        if self.starts.val() {
            self.live_now.next = self.old_live.val() + self.one.val();
        }
        self.fresh_now.next = self.newest.val() + self.one.val();
        self.runs.next =
            (self.word.val().get_bit(CONTROL_RUNNING) | self.starts.val()) & !self.halted.val();
        self.fits.next = self.runs.val() & !self.word.val().get_bit(CONTROL_UNFIT);
        self.none.next = self.newest.val() == self.live_now.val();

        // Decides what follows after this tick.
        self.last_one.next = self.lasts.read_data.val().any();
        self.ramps.next = self.ramp.val() & self.word.val().get_bit(CONTROL_KNOWN);
        self.follows.next =
            self.ended.val() & !self.last_one.val() & !self.none.val() & !self.ramp.val();
        self.moves.next = self.fits.val() & !self.least.val();
        self.over.next = self.ended.val() & self.last_one.val();
        if self.ramp.val() {
            self.over.next = self.ramps.val() & self.turned.val();
        }
        self.stays.next = self.moves.val() & !self.over.val();
        self.goes_on.next = self.stays.val();
        self.steps_on.next = self.moves.val() & self.follows.val();
        self.advances.next = self.steps_on.val();
        self.too_fast.next =
            self.runs.val() & (self.word.val().get_bit(CONTROL_UNFIT) | self.least.val());
        self.dry.next = self.moves.val()
            & self.ended.val()
            & !self.last_one.val()
            & self.none.val()
            & !self.ramp.val();

        // The host's words and its commit.
        self.due.next = self.word.val().get_bits::<3>(CONTROL_DUE);
        self.fits_in.next = self.put_word.val() == self.due.val();
        self.wrong.d.next = self.take.val() & !self.fits_in.val();
        self.misplaced.next = self.wrong.q.val();
        if self.beat.val().get_bit(BEAT_FIRST) {
            self.took.d.next = false;
        }
        if self.take.val() & self.fits_in.val() {
            self.took.d.next = true;
        }
        self.lasts.read_address.next = (bit_cast::<6, 3>(self.axis.val()) << self.at_3.val())
            | bit_cast::<6, 3>(self.live_now.val());
        self.lasts.write_address.next = (bit_cast::<6, 3>(self.axis.val()) << self.at_3.val())
            | bit_cast::<6, 3>(self.fresh_now.val());
        self.lasts.write_data.next = self.unset.val();
        if self.last.val() {
            self.lasts.write_data.next = self.set.val();
        }
        self.lasts.write_bits.next = self.unset.val();
        // Each word writes the mark; that of the commit is the last one and stays.
        if self.take.val() {
            self.lasts.write_bits.next = self.set.val();
        }

        // The control word for the next time slot of this axis.
        self.next_live.next = self.live_now.val();
        if self.steps_on.val() {
            self.next_live.next = self.live_now.val() + self.one.val();
        }
        // Emptying the queue changes `live` only, so that the slot that the host writes stays the
        // same.
        if self.empties.val() {
            self.next_live.next = self.newest.val();
        }
        self.next_newest.next = self.newest.val();
        if self.took.q.val() & (self.due.val() == self.commit.val()) {
            self.next_newest.next = self.fresh_now.val();
        }
        self.next_due.next = self.due.val();
        if self.took.q.val() {
            self.next_due.next = self.due.val() + self.one.val();
        }
        if self.clear.val() {
            self.next_live.next = self.zero.val();
            self.next_newest.next = self.zero.val();
            self.next_due.next = self.zero.val();
        }
        self.next_running.next = self.no.val();
        if self.stays.val() {
            self.next_running.next = self.running_bit.val();
        }
        self.next_unfit.next = self.no.val();
        if self.stays.val() & !self.follows.val() & !self.ramp.val() & self.overflow.val() {
            self.next_unfit.next = self.unfit_bit.val();
        }
        self.next_known.next = self.no.val();
        if self.stays.val() & self.ramp.val() {
            self.next_known.next = self.known_bit.val();
        }
        self.next_back.next = self.no.val();
        if (self.ramps.val() & self.word.val().get_bit(CONTROL_BACK))
            | (!self.ramps.val() & self.back.val())
        {
            self.next_back.next = self.back_bit.val();
        }
        self.next_met.next = self.no.val();
        if self.meets.val() {
            self.next_met.next = self.met_bit.val();
        }
        self.control.read_address.next = self.axis_next.val();
        self.control.write_address.next = self.axis.val();
        self.control.write_data.next = bit_cast::<21, 3>(self.next_live.val())
            | (bit_cast::<21, 3>(self.next_newest.val()) << self.at_3.val())
            | self.next_running.val()
            | self.next_unfit.val()
            | self.next_known.val()
            | self.next_back.val()
            | (bit_cast::<21, 3>(self.next_due.val()) << self.at_10.val())
            | self.next_met.val()
            | (bit_cast::<21, 7>(self.next_counts.val()) << self.at_14.val());
        self.control.write_bits.next = self.no.val();
        if self.beat.val().get_bit(BEAT_LAST) {
            self.control.write_bits.next = self.all.val();
        }

        self.live.next = self.live_now.val();
        self.fresh.next = self.fresh_now.val();
        self.filled.d.next = self.fresh_now.val() == self.live_now.val();
        self.full.next = self.filled.q.val();
        self.room.next = self.live_now.val() + !self.newest.val();
        self.empty.next = self.none.val();
        self.running.next = self.runs.val();
        self.sound.next = self.fits.val();
        self.slows.next = self.ramps.val();
        self.upward.next = self.word.val().get_bit(CONTROL_BACK);
        self.steady.next = self.ramp.val() & !self.word.val().get_bit(CONTROL_KNOWN);
        self.met.next = self.word.val().get_bit(CONTROL_MET);
        self.counts.next = self.word.val().get_bits::<7>(CONTROL_COUNTS);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn queue_synthesizes() {
        assert_synthesizes(Queue::default(), "carrystep_queue");
    }
}

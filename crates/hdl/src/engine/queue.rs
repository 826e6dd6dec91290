//! The segment queue of each axis, and the control word of the axis of the present time slot.
//!
//! An axis has 8, 16 or 32 slots in memory, each of which holds one segment. The running segment is
//! in slot `live`; its ticks, V and A serve as the registers of the axis. The segments up to
//! `newest` wait. The host writes the slot after `newest`. A cut makes the slot that the host has
//! named the newest one.
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
//! bits     0-4    5-9      10        11      12     13      14-16   17    18-24    25-29    30
//! field    live   newest   running   unfit   back   known   due     met   counts   target   named
//! ```
//!
//! `unfit` means that the next V does not fit in 64 bits. `back` and `known` belong to a ramp: its
//! first tick stores the sign of V in `back` and sets `known`. `due` is the number of the word that
//! the host must put next: the words of a segment come in order, and word 7 commits it. `met` means
//! that the axis has hit its own source, and that this tick outputs its state for that. `counts`
//! belongs to [`super::step_counts`]; the queue only keeps it. `named` means that the axis takes
//! part in the next cut, whose last segment is in the slot `target`.
//!
//! Cost: a memory of 8 words of 31 bits for the control words and one of 64 to 256 bits for the
//! marks of last segments. A transition to the next segment only increments `live`; no segment is
//! copied.

use super::layout::{
    BEAT_FIRST, BEAT_LAST, CONTROL_BACK, CONTROL_COUNTS, CONTROL_DUE, CONTROL_KNOWN, CONTROL_LIVE,
    CONTROL_MET, CONTROL_NAMED, CONTROL_NEWEST, CONTROL_RUNNING, CONTROL_TARGET, CONTROL_UNFIT,
    PUT_NAMES, PUT_NUMBER,
};
use crate::parameters::CUTS;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::memory::Memory;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use rust_hdl_core::prelude::*;

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
    pub put_word: Input<Word<4>>,
    /// The lowest bits of that word: the slot of the last segment that a cut keeps.
    pub put_slot: Input<Word<5>>,
    /// The committed segment is the last of its move.
    pub last: Input<Bit>,
    /// In this tick the queue examines the segment that was named for a cut.
    pub checks: Input<Bit>,
    /// In this tick the queue ends with the segment that was named, if one was.
    pub cuts: Input<Bit>,
    /// In this tick the queue forgets what was named.
    pub closes: Input<Bit>,
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
    pub live: Signal<Out, Word<5>>,
    /// The slot that the host writes.
    pub fresh: Signal<Out, Word<5>>,
    /// Fault: the word accepted in the clock before was not the one that was due.
    pub misplaced: Signal<Out, Bit>,
    /// From beat 1: no slot is free for the host.
    pub full: Signal<Out, Bit>,
    /// From beat 1: the number of segments for which the queue has space.
    pub room: Signal<Out, Word<5>>,
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
    /// In beat 12, while a cut is examined: the named segment neither waits nor runs after this
    /// tick, or a segment is partly written.
    pub misses: Signal<Out, Bit>,
    /// The words of this tick are those of the axis' own hit.
    pub met: Signal<Out, Bit>,
    /// `next_counts` of the time slot before of this axis, at first 0.
    pub counts: Signal<Out, Word<7>>,
    control: Memory<3, 31>,
    lasts: Memory<8, 1>,
    word: Signal<Local, Word<31>>,
    old_live: Signal<Local, Word<5>>,
    live_now: Signal<Local, Word<5>>,
    newest: Signal<Local, Word<5>>,
    target: Signal<Local, Word<5>>,
    is_named: Signal<Local, Bit>,  // the axis takes part in the next cut
    ends_here: Signal<Local, Bit>, // this queue is cut in this tick
    space: Signal<Local, Word<5>>, // `room`
    distance: Signal<Local, Word<5>>, // from the running slot to the named one
    span: Signal<Local, Word<6>>,
    is_live: Signal<Local, Bit>,
    waits: Signal<Local, Bit>,
    keeps: Signal<Local, Bit>,
    takes_word: Signal<Local, Bit>, // the host's word is one of a segment
    names: Signal<Local, Bit>,      // in beat 12: it names the slot of a cut
    fresh_now: Signal<Local, Word<5>>,
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
    // `room`, a clock later, so that no long path begins at the memory
    spare: Register<Word<5>>,
    took: Register<Bit>,  // the word that is due was accepted in this time slot
    wrong: Register<Bit>, // `misplaced`
    next_live: Signal<Local, Word<5>>,
    next_newest: Signal<Local, Word<5>>,
    next_running: Signal<Local, Word<31>>,
    next_unfit: Signal<Local, Word<31>>,
    next_known: Signal<Local, Word<31>>,
    next_back: Signal<Local, Word<31>>,
    next_due: Signal<Local, Word<3>>,
    next_met: Signal<Local, Word<31>>,
    next_target: Signal<Local, Word<5>>,
    next_named: Signal<Local, Word<31>>,
    has_cuts: Parameter<1>,
    slots: Parameter<5>,  // the greatest number of a slot
    beyond: Parameter<6>, // the bits above it
    one_slot: Literal<5, 1>,
    no_slot: Literal<5, 0>,
    named_bit: Literal<31, { 1 << CONTROL_NAMED }>,
    one: Literal<3, 1>,
    zero: Literal<3, 0>,
    no: Literal<31, 0>,
    running_bit: Literal<31, { 1 << CONTROL_RUNNING }>,
    unfit_bit: Literal<31, { 1 << CONTROL_UNFIT }>,
    back_bit: Literal<31, { 1 << CONTROL_BACK }>,
    known_bit: Literal<31, { 1 << CONTROL_KNOWN }>,
    all: Literal<31, 0x7fff_ffff>,
    met_bit: Literal<31, { 1 << CONTROL_MET }>,
    commit: Literal<3, 7>,
    set: Literal<1, 1>,
    unset: Literal<1, 0>,
    at_3: Literal<4, 3>,
    at_5: Literal<4, 5>,
    at_14: Literal<4, 14>,
    at_18: Literal<5, 18>,
    at_25: Literal<5, 25>,
}

impl Queue {
    /// Makes the queue of axes with this number of slots, 8, 16 or 32, of a build with cuts or
    /// without.
    pub fn new(slots: usize, cuts: bool) -> Self {
        let slots = slots as u64;
        Self {
            lasts: Memory::of_few_formulas((8 * slots).ilog2() as usize, &[]),
            has_cuts: Parameter::of(&CUTS.of::<32>(cuts).bits(0)),
            slots: Parameter::new(slots - 1),
            beyond: Parameter::new(0x3f & !(slots - 1)),
            ..Self::default()
        }
    }
}

impl Logic for Queue {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, spare, took, wrong);
        clock!(self, clock, control, lasts);

        // The control word of this time slot. A cut takes effect before anything else.
        self.word.next = self.control.read_data.val();
        self.old_live.next = self.word.val().get_bits::<5>(CONTROL_LIVE) & self.slots.val();
        self.target.next = self.word.val().get_bits::<5>(CONTROL_TARGET) & self.slots.val();
        self.is_named.next = self.word.val().get_bit(CONTROL_NAMED) & self.has_cuts.val().any();
        self.ends_here.next = self.cuts.val() & self.is_named.val();
        self.newest.next = self.word.val().get_bits::<5>(CONTROL_NEWEST) & self.slots.val();
        if self.ends_here.val() {
            self.newest.next = self.target.val();
        }
        self.live_now.next = self.old_live.val();
        if self.starts.val() {
            self.live_now.next = (self.old_live.val() + self.one_slot.val()) & self.slots.val();
        }
        self.fresh_now.next = (self.newest.val() + self.one_slot.val()) & self.slots.val();
        self.space.next = (self.live_now.val() + !self.newest.val()) & self.slots.val();
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

        // The segment that was named for a cut. It waits if its distance from the running one is at
        // most the number of waiting segments, which is the complement of the space.
        self.distance.next = (self.target.val() - self.live_now.val()) & self.slots.val();
        self.span.next = bit_cast::<6, 5>(self.distance.val()) + bit_cast::<6, 5>(self.space.val());
        self.is_live.next = !self.distance.val().any();
        self.waits.next = !(self.span.val() & self.beyond.val()).any()
            & !self.is_live.val()
            & !self.empties.val()
            & !self.clear.val();
        self.keeps.next =
            self.waits.val() | (self.is_live.val() & self.stays.val() & !self.follows.val());

        // The host's words and its commit.
        self.takes_word.next = self.take.val() & !self.put_word.val().get_bit(PUT_NAMES);
        self.names.next =
            self.take.val() & self.put_word.val().get_bit(PUT_NAMES) & self.has_cuts.val().any();
        self.due.next = self.word.val().get_bits::<3>(CONTROL_DUE);
        self.fits_in.next = self.put_word.val().get_bits::<3>(PUT_NUMBER) == self.due.val();
        self.wrong.d.next = self.takes_word.val() & !self.fits_in.val();
        self.misplaced.next = self.wrong.q.val();
        if self.beat.val().get_bit(BEAT_FIRST) {
            self.took.d.next = false;
        }
        if self.takes_word.val() & self.fits_in.val() {
            self.took.d.next = true;
        }
        self.lasts.read_address.next = (bit_cast::<8, 5>(self.live_now.val()) << self.at_3.val())
            | bit_cast::<8, 3>(self.axis.val());
        self.lasts.write_address.next = (bit_cast::<8, 5>(self.fresh_now.val()) << self.at_3.val())
            | bit_cast::<8, 3>(self.axis.val());
        self.lasts.write_data.next = self.unset.val();
        if self.last.val() {
            self.lasts.write_data.next = self.set.val();
        }
        self.lasts.write_bits.next = self.unset.val();
        // Each word writes the mark; that of the commit is the last one and stays.
        if self.takes_word.val() {
            self.lasts.write_bits.next = self.set.val();
        }

        // The control word for the next time slot of this axis.
        self.next_live.next = self.live_now.val();
        if self.steps_on.val() {
            self.next_live.next = (self.live_now.val() + self.one_slot.val()) & self.slots.val();
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
            self.next_live.next = self.no_slot.val();
            self.next_newest.next = self.no_slot.val();
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
        self.next_target.next = self.target.val();
        self.next_named.next = self.no.val();
        if self.is_named.val() & !self.closes.val() & !self.clear.val() {
            self.next_named.next = self.named_bit.val();
        }
        if self.names.val() {
            self.next_target.next = self.put_slot.val() & self.slots.val();
            self.next_named.next = self.named_bit.val();
        }
        self.misses.next = self.checks.val()
            & self.is_named.val()
            & (!self.keeps.val() | self.next_due.val().any());
        self.control.read_address.next = self.axis_next.val();
        self.control.write_address.next = self.axis.val();
        self.control.write_data.next = bit_cast::<31, 5>(self.next_live.val())
            | (bit_cast::<31, 5>(self.next_newest.val()) << self.at_5.val())
            | self.next_running.val()
            | self.next_unfit.val()
            | self.next_known.val()
            | self.next_back.val()
            | (bit_cast::<31, 3>(self.next_due.val()) << self.at_14.val())
            | self.next_met.val()
            | (bit_cast::<31, 7>(self.next_counts.val()) << self.at_18.val())
            | (bit_cast::<31, 5>(self.next_target.val()) << self.at_25.val())
            | self.next_named.val();
        self.control.write_bits.next = self.no.val();
        if self.beat.val().get_bit(BEAT_LAST) {
            self.control.write_bits.next = self.all.val();
        }

        self.live.next = self.live_now.val();
        self.fresh.next = self.fresh_now.val();
        self.spare.d.next = self.space.val();
        self.full.next = !self.spare.q.val().any();
        self.room.next = self.spare.q.val();
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
        for slots in [8, 32] {
            assert_synthesizes(Queue::new(slots, slots == 8), &format!("carrystep_queue_{slots}"));
        }
    }
}

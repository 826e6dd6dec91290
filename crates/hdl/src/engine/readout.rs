//! What the host reads: the words of the state of every axis, tick by tick, and copies of them.
//!
//! ```text
//! beat        4    5    6    7    8    9    10   11   12
//! state       P    n    pos  sw             P'   tick status
//!
//! snapshot    ___/^\_________________________________
//! asked       _____/^^^^^^^^^\_______________________
//! takes       ______________/^^^^^^^^^^^^^\__________   from strobe to strobe
//! page        live           | snapshot   | live
//! ```
//!
//! Each time slot reads the state of its axis from memory anyway, one word per clock. This module
//! names the words: it outputs page and item beside the word that the memory returns. The words of
//! a tick all belong to the strobe before it, so a tick whose words go to a page of their own is a
//! snapshot of all axes. The latch has such a page too, and comes first; the hit of a seek is
//! output in the next tick that the latch does not need; a snapshot waits for both.
//!
//! In a tick that samples a switch in each time slot, beat 7 names the levels of the switch.
//!
//! Interface: the host's link stores each word at the address that page, item and axis make.
//!
//! Cost: four flip-flops and some 35 cells, half of which put the status and the levels of a switch
//! in place of a word of the memory.

use super::layout::{
    BEAT_LAST, BEAT_STATE_LEFT, BEAT_STATE_P_HIGH, BEAT_STATE_P_LOW, BEAT_STATE_POSITION,
    BEAT_STATE_STATUS, BEAT_STATE_SWITCH, BEAT_STATE_TICK,
};
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::engine::{SWITCH_LEVEL, SWITCH_STATE};
use rust_hdl_core::prelude::*;

/// Pages and items of the words of state, and the requests for snapshots.
#[derive(LogicBlock, Default)]
pub struct Readout {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick.
    pub strobe: Input<Bit>,
    /// The beats of [`super::time_slot`]: bit i is asserted in beat i of a time slot.
    pub beat: Input<Word<17>>,
    /// The time slot is that of the last axis.
    pub is_last: Input<Bit>,
    /// The host requests a snapshot.
    pub snapshot: Input<Bit>,
    /// In beat 12: the axis has hit its own source.
    pub caught: Input<Bit>,
    /// The words of the axis are still to be output for the hit of its own source.
    pub met: Input<Bit>,
    /// At a strobe: the common source of all axes was hit in this tick.
    pub sweeps: Input<Bit>,
    /// At a strobe: the next tick outputs the words of the latch.
    pub comes: Input<Bit>,
    /// This tick outputs the words of the latch.
    pub latches: Input<Bit>,
    /// In this tick a switch is sampled in each time slot.
    pub samples: Input<Bit>,
    /// The row of that switch.
    pub row: Input<Word<2>>,
    /// In beat 7: the debounced state of that switch, before this sample.
    pub earlier: Input<Bit>,
    /// In beat 7: the level of its pin.
    pub level: Input<Bit>,
    /// The last two ticks of a reset: no word of a switch is output.
    pub resetting: Input<Bit>,
    /// The word that the memory returns.
    pub word: Input<Word<32>>,
    /// The slot of the running segment.
    pub live: Input<Word<5>>,
    /// The axis runs in this tick.
    pub running: Input<Bit>,
    /// The number of segments for which the queue has space.
    pub room: Input<Word<5>>,
    /// Carries less counted steps, modulo 16.
    pub on_way: Input<Word<4>>,
    /// A word of the state of the axis of this time slot is output.
    pub valid: Signal<Out, Bit>,
    /// Its page.
    pub page: Signal<Out, Word<2>>,
    /// Its item.
    pub item: Signal<Out, Word<3>>,
    /// The word. Of the status, bits 31 to 16 have no meaning.
    pub state: Signal<Out, Word<32>>,
    /// All live words of this tick have been output.
    pub refreshed: Signal<Out, Bit>,
    /// In beat 12: the words of the axis are to be output for the hit of its own source, in the
    /// next tick that the latch does not need.
    pub meets: Signal<Out, Bit>,
    asked: Register<Bit>,
    takes: Register<Bit>,
    found: Register<Bit>,     // in this tick an axis had a reason for `meets`
    swept: Register<Bit>,     // as `met`, for all axes, after the hit of their common source
    owed: Signal<Local, Bit>, // `meets`
    captured: Signal<Local, Bit>,
    taken: Signal<Local, Bit>, // at a strobe: the next tick is no snapshot
    of_switch: Signal<Local, Bit>,
    levels: Signal<Local, Word<16>>,
    status: Signal<Local, Word<16>>,
    low: Signal<Local, Word<16>>,
    running_now: Signal<Local, Word<16>>,
    waiting: Signal<Local, Word<5>>,
    ticks_left: Signal<Local, Bit>,
    p_or_position: Signal<Local, Bit>,
    odd: Signal<Local, Bit>,
    slots: Parameter<5>, // the greatest number of a slot
    high_half: Literal<32, 0xffff_0000>,
    no_status: Literal<16, 0>,
    running_bit: Literal<16, 0x20>,
    at_6: Literal<4, 6>,
    at_12: Literal<4, 12>,
    hit_page: Literal<2, 0>,
    live_page: Literal<2, 1>,
    snapshot_page: Literal<2, 2>,
    latch_page: Literal<2, 3>,
    state_bit: Literal<16, { SWITCH_STATE as u64 }>,
    level_bit: Literal<16, { SWITCH_LEVEL as u64 }>,
    other_bits: Literal<16, { !(SWITCH_STATE | SWITCH_LEVEL) as u64 & 0xffff }>,
    no_item: Literal<3, 0>,
    odd_item: Literal<3, 1>,
    middle_item: Literal<3, 2>,
    high_item: Literal<3, 4>,
}

impl Readout {
    /// Makes the readout of axes with this number of slots, 8, 16 or 32.
    pub fn new(slots: usize) -> Self {
        Self { slots: Parameter::new(slots as u64 - 1), ..Self::default() }
    }
}

impl Logic for Readout {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, asked, takes, found, swept);

        // The words that are to be output for a hit. The latch delays them by a tick.
        self.owed.next = self.caught.val() | (self.met.val() & self.latches.val());
        if self.owed.val() & self.beat.val().get_bit(BEAT_LAST) {
            self.found.d.next = true;
        }
        if self.strobe.val() {
            self.found.d.next = false;
            self.swept.d.next = self.sweeps.val() | (self.swept.q.val() & self.latches.val());
        }
        self.captured.next = self.met.val() | self.swept.q.val();
        self.meets.next = self.owed.val();

        // Requests for snapshots.
        self.taken.next = self.found.q.val()
            | self.sweeps.val()
            | (self.swept.q.val() & self.latches.val())
            | self.comes.val();
        if self.strobe.val() {
            self.takes.d.next = self.asked.q.val() & !self.taken.val();
            self.asked.d.next = self.asked.q.val() & self.taken.val();
        }
        if self.snapshot.val() {
            self.asked.d.next = true;
        }

        // The page.
        self.of_switch.next =
            self.beat.val().get_bit(BEAT_STATE_SWITCH) & self.samples.val() & !self.resetting.val();
        self.page.next = self.live_page.val();
        if self.captured.val() {
            self.page.next = self.hit_page.val();
        }
        if self.takes.q.val() {
            self.page.next = self.snapshot_page.val();
        }
        if self.latches.val() {
            self.page.next = self.latch_page.val();
        }
        if self.of_switch.val() {
            self.page.next = self.row.val();
        }

        // The item, bit by bit: 0 discarded, 1 left, 2 switch, 3 tick, 4 and 5 P, 6 position, 7
        // status.
        self.ticks_left.next = self.beat.val().get_bit(BEAT_STATE_LEFT);
        self.p_or_position.next = self.beat.val().get_bit(BEAT_STATE_P_LOW)
            | self.beat.val().get_bit(BEAT_STATE_P_HIGH)
            | self.beat.val().get_bit(BEAT_STATE_POSITION);
        self.odd.next = (self.ticks_left.val() & self.running.val())
            | self.beat.val().get_bit(BEAT_STATE_P_HIGH)
            | self.beat.val().get_bit(BEAT_STATE_TICK)
            | self.beat.val().get_bit(BEAT_STATE_STATUS);
        self.item.next = self.no_item.val();
        if self.odd.val() {
            self.item.next = self.odd_item.val();
        }
        if self.beat.val().get_bit(BEAT_STATE_TICK)
            | self.beat.val().get_bit(BEAT_STATE_POSITION)
            | self.beat.val().get_bit(BEAT_STATE_STATUS)
            | self.of_switch.val()
        {
            self.item.next = self.item.val() | self.middle_item.val();
        }
        if self.p_or_position.val() | self.beat.val().get_bit(BEAT_STATE_STATUS) {
            self.item.next = self.item.val() | self.high_item.val();
        }
        self.valid.next = (self.ticks_left.val() & (!self.captured.val() | self.latches.val()))
            | self.of_switch.val()
            | self.p_or_position.val()
            | self.beat.val().get_bit(BEAT_STATE_TICK)
            | self.beat.val().get_bit(BEAT_STATE_STATUS);

        // The word. A queue has room for the complement of what waits.
        self.running_now.next = self.no_status.val();
        if self.running.val() {
            self.running_now.next = self.running_bit.val();
        }
        self.waiting.next = !self.room.val() & self.slots.val();
        self.status.next = bit_cast::<16, 5>(self.live.val())
            | self.running_now.val()
            | (bit_cast::<16, 5>(self.waiting.val()) << self.at_6.val())
            | (bit_cast::<16, 4>(self.on_way.val()) << self.at_12.val());
        self.low.next = self.word.val().get_bits::<16>(0);
        if self.beat.val().get_bit(BEAT_STATE_STATUS) {
            self.low.next = self.status.val();
        }
        self.levels.next = self.no_status.val();
        if self.earlier.val() {
            self.levels.next = self.state_bit.val();
        }
        if self.level.val() {
            self.levels.next = self.levels.val() | self.level_bit.val();
        }
        if self.of_switch.val() {
            self.low.next =
                (self.word.val().get_bits::<16>(0) & self.other_bits.val()) | self.levels.val();
        }
        self.state.next =
            (self.word.val() & self.high_half.val()) | bit_cast::<32, 16>(self.low.val());
        self.refreshed.next = self.beat.val().get_bit(BEAT_STATE_STATUS)
            & self.is_last.val()
            & !self.takes.q.val()
            & !self.captured.val()
            & !self.latches.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn readout_synthesizes() {
        assert_synthesizes(Readout::new(8), "carrystep_readout");
    }
}

//! The counting of steps: how pulses and discarded steps reach the counters in memory, and how many
//! steps are on their way from the accumulator to the pin.
//!
//! ```text
//! beat        4           5          6                7              12
//! pulser      losses                 pulses
//! memory                             position ------> position +- 1
//! kept        discarded --> lost                                     discarded + lost
//! kept                                                               on_way + carry - up + down
//! ```
//!
//! The pulser of an axis counts pulses and discarded steps modulo 8. Each time slot compares these
//! counts with those that the memory has, and adds at most one of each to the memory. So the
//! position in memory follows the pins by at most one step in a tick. Discarded steps follow only
//! while the axis does not run, because their word in memory is not read otherwise.
//!
//! `on_way` is the number of carries since the last clear less the steps that the position has
//! counted since then.
//!
//! Interface: the adder adds `up`, `down` and `lost` in the beats in which they are valid. The
//! queue keeps `next_counts` in the control word of the axis, and returns it as `counts` in the
//! next time slot.
//!
//! Cost: three flip-flops, seven bits of the control word and some 25 cells. The low bits of the
//! position are compared as they come from memory, so the control word need not keep them.

use super::layout::{
    BEAT_COMPARE_DISCARDED, BEAT_LOAD_POSITION, KEPT_DISCARDED, KEPT_ON_WAY, MISSING_SIGN,
};
use crate::primitives::constant::Literal;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use rust_hdl_core::prelude::*;

/// The comparison of the pulser's counts with those in memory, and the number of steps on their
/// way.
#[derive(LogicBlock, Default)]
pub struct StepCounts {
    /// The clock.
    pub clock: Input<Clock>,
    /// The beats of [`super::time_slot`]: bit i is asserted in beat i of a time slot.
    pub beat: Input<Word<17>>,
    /// The axis runs in this tick.
    pub running: Input<Bit>,
    /// In beat 12: the axis runs and its V is in range.
    pub moves: Input<Bit>,
    /// In beat 12: P + V crosses a step, if the axis moves.
    pub crosses: Input<Bit>,
    /// In beat 12: V < 0.
    pub back: Input<Bit>,
    /// No step is on its way any more.
    pub clear: Input<Bit>,
    /// The low bits of the position, from the pulser of the axis.
    pub pulses: Input<Word<3>>,
    /// The low bits of the discarded steps, from the pulser of the axis.
    pub losses: Input<Word<3>>,
    /// The lowest bits of the word that the memory returns. In beat 6 it is the position.
    pub word: Input<Word<3>>,
    /// `next_counts` of the time slot before of this axis, at first 0.
    pub counts: Input<Word<7>>,
    /// In beat 12: what is kept until the next time slot of the axis.
    pub next_counts: Signal<Out, Word<7>>,
    /// In beat 6: a step forward is added to the position.
    pub up: Signal<Out, Bit>,
    /// In beat 6: a step backward is subtracted from the position.
    pub down: Signal<Out, Bit>,
    /// From beat 5: a discarded step is counted. Asserted only while the axis does not run.
    pub lost: Signal<Out, Bit>,
    /// Carries since the last clear less counted steps, modulo 16.
    pub on_way: Signal<Out, Word<4>>,
    missing: Signal<Local, Word<3>>,
    unseen: Signal<Local, Word<3>>,
    more: Signal<Local, Bit>,
    less: Signal<Local, Bit>,
    forward: Register<Bit>,     // `up`, after beat 6
    backward: Register<Bit>,    // `down`, after beat 6
    gone: Register<Bit>,        // `lost`
    ahead: Signal<Local, Bit>,  // the tick contains a step forward
    behind: Signal<Local, Bit>, // the tick contains a step backward
    gain: Signal<Local, Word<4>>,
    next_lost: Signal<Local, Word<3>>,
    next_on_way: Signal<Local, Word<4>>,
    one: Literal<3, 1>,
    none_on_way: Literal<4, 0>,
    one_more: Literal<4, 1>,
    two_more: Literal<4, 2>,
    one_less: Literal<4, 15>,
    two_less: Literal<4, 14>,
    at_3: Literal<3, 3>,
}

impl Logic for StepCounts {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, forward, backward, gone);

        // The difference of the low bits shows which steps the memory has not counted yet.
        self.missing.next = self.pulses.val() - self.word.val();
        self.more.next = self.missing.val().any() & !self.missing.val().get_bit(MISSING_SIGN);
        self.less.next = self.missing.val().get_bit(MISSING_SIGN);
        if self.beat.val().get_bit(BEAT_LOAD_POSITION) {
            self.forward.d.next = self.more.val();
            self.backward.d.next = self.less.val();
        }
        self.unseen.next = self.losses.val() ^ self.counts.val().get_bits::<3>(KEPT_DISCARDED);
        if self.beat.val().get_bit(BEAT_COMPARE_DISCARDED) {
            self.gone.d.next = self.unseen.val().any() & !self.running.val();
        }

        // What is kept for the next time slot of this axis.
        self.next_lost.next = self.counts.val().get_bits::<3>(KEPT_DISCARDED);
        if self.gone.q.val() {
            self.next_lost.next = self.counts.val().get_bits::<3>(KEPT_DISCARDED) + self.one.val();
        }
        self.ahead.next = self.moves.val() & self.crosses.val() & !self.back.val();
        self.behind.next = self.moves.val() & self.crosses.val() & self.back.val();
        self.gain.next = self.none_on_way.val();
        if self.forward.q.val() {
            self.gain.next = self.one_less.val();
        }
        if self.backward.q.val() {
            self.gain.next = self.one_more.val();
        }
        if self.ahead.val() {
            self.gain.next = self.one_more.val();
            if self.forward.q.val() {
                self.gain.next = self.none_on_way.val();
            }
            if self.backward.q.val() {
                self.gain.next = self.two_more.val();
            }
        }
        if self.behind.val() {
            self.gain.next = self.one_less.val();
            if self.forward.q.val() {
                self.gain.next = self.two_less.val();
            }
            if self.backward.q.val() {
                self.gain.next = self.none_on_way.val();
            }
        }
        self.next_on_way.next = self.counts.val().get_bits::<4>(KEPT_ON_WAY) + self.gain.val();
        if self.clear.val() {
            self.next_on_way.next = self.none_on_way.val();
        }

        self.next_counts.next = bit_cast::<7, 3>(self.next_lost.val())
            | (bit_cast::<7, 4>(self.next_on_way.val()) << self.at_3.val());
        self.up.next = self.more.val();
        self.down.next = self.less.val();
        self.lost.next = self.gone.q.val();
        self.on_way.next = self.counts.val().get_bits::<4>(KEPT_ON_WAY);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn step_counts_synthesizes() {
        assert_synthesizes(StepCounts::default(), "carrystep_step_counts");
    }
}

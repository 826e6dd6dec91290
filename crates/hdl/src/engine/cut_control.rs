//! The cut: drops the segments behind a named one in several axes at one strobe, or in none.
//!
//! ```text
//! request  _/^\_________________________________
//! asked    ___/^^^^^^^^\________________________
//! strobe   __________/^\_________/^\_________/^\_
//! checks   ____________/^^^^^^^^^^^\____________   each time slot examines the axis
//! closes   ________________________/^^^^^^^^^^^\_   the axes forget what was named
//! cuts     ________________________/^^^^^^^^^^^\_   unless it is refused: the queues end at the name
//! ```
//!
//! The host has named a segment in each axis of the cut. In the tick with `checks`, each of these
//! axes finds whether its named segment still waits or runs after this tick. In the next tick, the
//! queues of all these axes end with the named segment, or the cut is refused.
//!
//! Interface: [`super::queue`] keeps the names and ends the queues.
//!
//! Cost: five flip-flops, and some 25 cells in the queue. A build without cuts has none of them,
//! and refuses each.

use super::layout::BEAT_LAST;
use crate::parameters::CUTS;
use crate::primitives::constant::{Parameter, ParameterRefusal};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

/// The stages of a cut.
#[derive(LogicBlock, Default)]
pub struct CutControl {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick.
    pub strobe: Input<Bit>,
    /// The beats of [`super::time_slot`]: bit i is asserted in beat i of a time slot.
    pub beat: Input<Word<17>>,
    /// The host requests a cut.
    pub request: Input<Bit>,
    /// In beat 12: the axis was named, and its segment neither waits nor runs after this tick.
    pub misses: Input<Bit>,
    /// A reset: no cut is requested.
    pub resetting: Input<Bit>,
    /// In this tick the time slots examine the named segments.
    pub checks: Signal<Out, Bit>,
    /// In this tick the queues of the named axes end with the named segment.
    pub cuts: Signal<Out, Bit>,
    /// In this tick the axes forget what was named.
    pub closes: Signal<Out, Bit>,
    /// A cut was requested and is not decided yet.
    pub busy: Signal<Out, Bit>,
    /// The last cut was refused.
    pub refused: Signal<Out, Bit>,
    asked: Register<Bit>,
    checking: Register<Bit>, // `checks`
    closing: Register<Bit>,  // `closes`
    missed: Register<Bit>,   // an axis of this tick has no named segment any more
    denied: Register<Bit>,   // `refused`
    exist: Parameter<1>,
    cuts_out_of_range: ParameterRefusal,
}

impl CutControl {
    /// Makes the stages of a build with cuts, or without.
    pub fn new(cuts: bool) -> Self {
        let cuts = CUTS.of::<32>(cuts);
        Self {
            exist: Parameter::of(&cuts.bits(0)),
            cuts_out_of_range: ParameterRefusal::of(&cuts.is_outside(0, 1)),
            ..Self::default()
        }
    }
}

impl Logic for CutControl {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, asked, checking, closing, missed, denied);

        if self.beat.val().get_bit(BEAT_LAST) & self.misses.val() {
            self.missed.d.next = true;
        }
        if self.strobe.val() {
            self.asked.d.next = false;
            self.checking.d.next = self.asked.q.val();
            self.closing.d.next = self.checking.q.val();
            self.missed.d.next = false;
            if self.checking.q.val() {
                self.denied.d.next = self.missed.q.val();
            }
        }
        if self.request.val() & self.exist.val().any() {
            self.asked.d.next = true;
        }
        if self.resetting.val() {
            self.asked.d.next = false;
            self.checking.d.next = false;
            if self.strobe.val() {
                self.denied.d.next = false;
            }
        }

        self.checks.next = self.checking.q.val();
        self.closes.next = self.closing.q.val();
        self.cuts.next = self.closing.q.val() & !self.denied.q.val();
        self.busy.next = self.asked.q.val() | self.checking.q.val();
        self.refused.next = self.denied.q.val() | !self.exist.val().any();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn cut_control_synthesizes() {
        assert_synthesizes(CutControl::new(true), "carrystep_cut_control");
    }
}

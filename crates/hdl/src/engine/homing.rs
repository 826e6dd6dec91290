//! Homing: an axis that waits for its limit and meets it slows down alone, and its queue is emptied.
//!
//! ```text
//! set      /^\_______________________________________
//! waits    __/^^^^^^^^^^^^^^^^^^^^^\__________________   `axes`, a bit each: the engine's host sees them
//! hit      _______________________/^\________________   the axis' own, in the last beat of its turn
//! slows    _________________________/^^^^^^^^^^^^\____   in its turns only: a ramp, until it rests
//! ```

use crate::constant::Literal;
use crate::register::{Input, Register};
use crate::word::Word;
use rust_hdl::prelude::*;

/// The axes that wait for their limit, and those that have met it.
#[derive(LogicBlock, Default)]
pub struct Homing<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// The host says anew which axes wait,
    pub set: Input<Bit>,
    /// namely these.
    pub mask: Input<Word<N>>,
    /// Last beat of a turn.
    pub turn_ends: Input<Bit>,
    /// The axis of the turn, one bit.
    pub lane: Input<Word<N>>,
    /// It has reached a limit.
    pub hit: Input<Bit>,
    /// It runs in the next tick too.
    pub goes_on: Input<Bit>,
    /// The axes that wait for their limit.
    pub axes: Signal<Out, Word<N>>,
    /// The axis of this turn does.
    pub waits: Signal<Out, Bit>,
    /// It has met its limit and slows down.
    pub slows: Signal<Out, Bit>,
    waiting: Register<Word<N>>,
    slowing: Register<Word<N>>,
    mine: Signal<Local, Bit>,
    mine_slows: Signal<Local, Bit>,
    caught: Signal<Local, Bit>,
    slower: Signal<Local, Word<N>>,
    none: Literal<N, 0>,
}

impl<const N: usize> Logic for Homing<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, waiting, slowing);
        self.mine.next = (self.waiting.q.val() & self.lane.val()).any();
        self.mine_slows.next = (self.slowing.q.val() & self.lane.val()).any();
        self.caught.next = self.hit.val() & self.mine.val();

        if self.caught.val() {
            self.waiting.d.next = self.waiting.q.val() & !self.lane.val();
        }
        if self.set.val() {
            self.waiting.d.next = self.mask.val();
        }
        // Whoever rests has slowed down.
        self.slower.next = self.none.val();
        if self.caught.val() {
            self.slower.next = self.lane.val();
        }
        if self.turn_ends.val() {
            self.slowing.d.next = self.slowing.q.val() | self.slower.val();
            if !self.goes_on.val() {
                self.slowing.d.next = (self.slowing.q.val() & !self.lane.val()) | self.slower.val();
            }
        }

        self.axes.next = self.waiting.q.val();
        self.waits.next = self.mine.val();
        self.slows.next = self.mine_slows.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn homing_synthesizes() {
        assert_synthesizes(Homing::<6>::default(), "carrystep_homing");
    }
}

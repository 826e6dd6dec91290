//! Homing: an axis that waits for its limit and meets it slows down alone, and its queue is emptied.
//!
//! ```text
//! set      /^\_______________________________________
//! waits    __/^^^^^^^^^^^^^^^^^^^^^\__________________   `axes`, a bit each: the engine's host sees them
//! hit      _______________________/^\________________   the axis' own, in the last beat of its turn
//! slows    _________________________/^^^^^^^^^^^^\____   in its turns only: a ramp, until it rests
//! ```

use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use rust_hdl::prelude::*;

/// The axes that wait for their limit, and those that have met it.
#[derive(LogicBlock, Default)]
pub struct Homes<const N: usize> {
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
    lane_next: Signal<Local, Word<N>>,
    mine_slows: Register<Bit>, // known with the turn's first beat: the whole ramp hangs on it
    caught: Signal<Local, Bit>,
    slower: Signal<Local, Word<N>>,
    none: Literal<N, 0>,
    by_one: Literal<1, 1>,
    to_top: Parameter<3>,
}

impl<const N: usize> Homes<N> {
    /// The homing of N axes.
    pub fn new() -> Self {
        Self { to_top: Parameter::new(N as u64 - 1), ..Self::default() }
    }
}

impl<const N: usize> Logic for Homes<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, waiting, slowing, mine_slows);
        self.mine.next = (self.waiting.q.val() & self.lane.val()).any();
        self.lane_next.next = self.lane.val();
        if self.turn_ends.val() {
            self.lane_next.next = (self.lane.val() << self.by_one.val()) | (self.lane.val() >> self.to_top.val());
        }
        self.mine_slows.d.next = (self.slowing.q.val() & self.lane_next.val()).any();
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
        self.slows.next = self.mine_slows.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn homes_synthesizes() {
        assert_synthesizes(Homes::<6>::new(), "carrystep_homes");
    }
}

//! Holds the running and one waiting segment of an axis, and decides when the waiting one is
//! loaded.
//!
//! ```text
//!              load            load (no gap)    last: the axis rests
//! waiting  ^^^^^^\_____/^^^^^^^^^^\_____________
//! running  ______/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\__
//! left           n  n-1 ...  2  1  m  m-1 ... 1
//! ```
//!
//! The sequencer loads a waiting segment at the strobe that ends the running segment. If the axis
//! is at rest, or comes to rest at that strobe, it loads the segment only when the core asserts
//! `go`. If a segment that is not marked last ends and no segment waits, the sequencer latches the
//! fault `underrun`.
//!
//! Cost: registers for one waiting segment (225 bits) and a counter of the remaining ticks (32
//! bits).

use crate::primitives::constant::Literal;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

/// The segment sequencer of one axis.
#[derive(LogicBlock, Default)]
pub struct Sequencer {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of a tick, unless the core is frozen.
    pub strobe: Input<Bit>,
    /// Asserted while a fault is latched. The axis stops running.
    pub frozen: Input<Bit>,
    /// The next V is out of range. The axis stops running.
    pub stop: Input<Bit>,
    /// Clears the waiting segment and the fault.
    pub clear: Input<Bit>,
    /// The waiting segment may start an axis at rest in this clock.
    pub go: Input<Bit>,
    /// The sequencer stores the offered segment in this clock.
    pub push: Input<Bit>,
    /// Offered segment: its duration in ticks.
    pub seg_ticks: Input<Word<32>>,
    /// Offered segment: the initial speed V, in 2^-64 step per tick, two's complement.
    pub seg_v: Input<Word<64>>,
    /// Offered segment: the initial acceleration A, in 2^-64 step per tick^2, two's complement.
    pub seg_a: Input<Word<64>>,
    /// Offered segment: the jerk J, in 2^-64 step per tick^3, two's complement.
    pub seg_j: Input<Word<64>>,
    /// Offered segment: it is the last of its move, and the axis rests after it.
    pub seg_last: Input<Bit>,
    /// A segment is stored and not yet loaded.
    pub waiting: Signal<Out, Bit>,
    /// The waiting segment could start at a strobe in this clock.
    pub startable: Signal<Out, Bit>,
    /// A segment runs.
    pub running: Signal<Out, Bit>,
    /// The axis loads V, A and J from the waiting segment.
    pub load: Signal<Out, Bit>,
    /// The running segment continues: the axis advances V and A.
    pub advance: Signal<Out, Bit>,
    /// The V of the waiting segment.
    pub v: Signal<Out, Word<64>>,
    /// The A of the waiting segment.
    pub a: Signal<Out, Word<64>>,
    /// The J of the waiting segment.
    pub j: Signal<Out, Word<64>>,
    /// Latched fault: a segment that was not the last of its move ended, and no segment was
    /// waiting.
    pub underrun: Signal<Out, Bit>,
    wait_full: Register<Bit>, // `waiting`
    wait_ticks: Register<Word<32>>,
    wait_v: Register<Word<64>>,
    wait_a: Register<Word<64>>,
    wait_j: Register<Word<64>>,
    wait_last: Register<Bit>,
    active: Register<Bit>, // `running` of docs/clock-by-clock.md
    left: Register<Word<32>>,
    last: Register<Bit>,
    dry: Register<Bit>, // `underrun`
    ending: Signal<Local, Bit>,
    one: Literal<32, 1>,
}

impl Logic for Sequencer {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(
            self, clock, wait_full, wait_ticks, wait_v, wait_a, wait_j, wait_last, active, left,
            last, dry
        );

        self.ending.next = self.active.q.val() & (self.left.q.val() == self.one.val());
        self.startable.next = self.wait_full.q.val()
            & (!self.active.q.val() | (self.ending.val() & self.last.q.val()));
        self.load.next = self.strobe.val()
            & self.wait_full.q.val()
            & ((self.ending.val() & !self.last.q.val()) | (self.startable.val() & self.go.val()));
        self.advance.next = self.strobe.val() & self.active.q.val() & !self.ending.val();

        if self.push.val() {
            self.wait_full.d.next = true;
            self.wait_ticks.d.next = self.seg_ticks.val();
            self.wait_v.d.next = self.seg_v.val();
            self.wait_a.d.next = self.seg_a.val();
            self.wait_j.d.next = self.seg_j.val();
            self.wait_last.d.next = self.seg_last.val();
        }
        if self.load.val() {
            self.wait_full.d.next = false;
            self.active.d.next = true;
            self.left.d.next = self.wait_ticks.q.val();
            self.last.d.next = self.wait_last.q.val();
        } else if self.advance.val() {
            self.left.d.next = self.left.q.val() - self.one.val();
        } else if self.strobe.val() {
            self.active.d.next = false;
            self.dry.d.next = self.dry.q.val() | (self.ending.val() & !self.last.q.val());
        }
        if self.frozen.val() | self.stop.val() {
            self.active.d.next = false;
        }
        if self.clear.val() {
            self.wait_full.d.next = false;
            self.dry.d.next = false;
        }

        self.waiting.next = self.wait_full.q.val();
        self.running.next = self.active.q.val();
        self.v.next = self.wait_v.q.val();
        self.a.next = self.wait_a.q.val();
        self.j.next = self.wait_j.q.val();
        self.underrun.next = self.dry.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{assert_synthesizes, rising_edge, settle};

    /// Runs one clock. Returns the outputs `load` and `advance` before its rising edge.
    fn clock(sequencer: &mut Sequencer) -> (bool, bool) {
        sequencer.clock.next = false.into();
        settle(sequencer);
        let said = (sequencer.load.val(), sequencer.advance.val());
        sequencer.clock.next = true.into();
        rising_edge(sequencer);
        settle(sequencer);
        said
    }

    fn push(sequencer: &mut Sequencer, ticks: u64, last: bool) {
        sequencer.push.next = true;
        sequencer.strobe.next = false;
        sequencer.seg_ticks.next = Word::from(ticks);
        sequencer.seg_last.next = last;
        clock(sequencer);
        sequencer.push.next = false;
        sequencer.strobe.next = true;
    }

    fn connected() -> Sequencer {
        let mut sequencer = Sequencer::default();
        sequencer.connect_all();
        sequencer
    }

    #[test]
    fn sequencer_at_rest_loads_only_with_go() {
        let mut sequencer = connected();
        push(&mut sequencer, 2, true);
        assert!(sequencer.startable.val());
        assert_eq!(clock(&mut sequencer), (false, false));
        sequencer.go.next = true;
        assert_eq!(clock(&mut sequencer), (true, false));
        assert!(sequencer.running.val() && !sequencer.waiting.val());
    }

    #[test]
    fn sequencer_loads_the_next_segment_without_a_gap_and_rests_after_the_last() {
        let mut sequencer = connected();
        push(&mut sequencer, 2, false);
        sequencer.go.next = true;
        clock(&mut sequencer);
        sequencer.go.next = false;
        push(&mut sequencer, 1, true);
        let said: Vec<_> = (0..3).map(|_| clock(&mut sequencer)).collect();
        assert_eq!(said, [(false, true), (true, false), (false, false)]);
        assert!(!sequencer.running.val() && !sequencer.underrun.val());
    }

    #[test]
    fn missing_segment_is_an_underrun_until_cleared() {
        let mut sequencer = connected();
        push(&mut sequencer, 1, false);
        sequencer.go.next = true;
        clock(&mut sequencer);
        clock(&mut sequencer);
        assert!(sequencer.underrun.val() && !sequencer.running.val());
        sequencer.clear.next = true;
        clock(&mut sequencer);
        assert!(!sequencer.underrun.val());
    }

    #[test]
    fn sequencer_synthesizes() {
        assert_synthesizes(Sequencer::default(), "carrystep_sequencer");
    }
}

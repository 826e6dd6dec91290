//! The tick counter: divides time into ticks of C clocks, and each tick into Q phases.
//!
//! ```text
//! phase        |  0        |  1        | ... |  Q-1      |  0
//! sub          | 0 | 1 | 2 | 0 | 1 | 2 |     | 0 | 1 | 2 | 0        (C/Q = 3)
//! phase_start  /^^^\_______/^^^\_______       /^^^\_______/^^^
//! strobe       ________________________       ________/^^^\___
//! ```
//!
//! Interface: `strobe` ends each tick and `phase_start` begins each phase. One counter serves all
//! axes, so that they share the same time base.
//!
//! Cost: a counter of clocks within the phase, as wide as C/Q requires, and a counter of phases of
//! 4 bits.

use crate::parameters::CLOCKS_PER_TICK;
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::Timebase;
use carrystep_core::build::{MAX_CLOCKS, MIN_CLOCKS_PER_TICK};
use rust_hdl_core::prelude::*;

/// Counts clocks within a phase, and phases within a tick.
#[derive(LogicBlock, Default)]
pub struct Tick {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last clock of each tick.
    pub strobe: Signal<Out, Bit>,
    /// Asserted in the first clock of each phase.
    pub phase_start: Signal<Out, Bit>,
    /// The number of the present phase, 0 to Q - 1.
    pub phase: Signal<Out, Word<4>>,
    sub: Register<Word<16>>,
    phases: Register<Word<4>>,
    sub_over: Signal<Local, Bit>,
    phase_over: Signal<Local, Bit>,
    zero: Literal<16, 0>,
    one: Literal<16, 1>,
    last_sub: Parameter<16>,
    sub_bits: Parameter<16>,
    first_phase: Literal<4, 0>,
    one_phase: Literal<4, 1>,
    last_phase: Parameter<4>,
    clocks_per_tick_out_of_range: ParameterRefusal,
}

impl Tick {
    /// Makes the counter of a timebase. [`Timebase`] has checked that Q divides C.
    pub fn new(timebase: &Timebase) -> Self {
        let clocks = CLOCKS_PER_TICK.of::<32>(timebase.clocks_per_tick());
        // A shift divides by the phases, which are a power of two; 65536 of one phase are 0 in 16
        // bits.
        let last_sub = clocks.bits::<16>(timebase.phase_bits() as usize) - Formula::number(1);
        let outside = clocks.is_outside(MIN_CLOCKS_PER_TICK.into(), MAX_CLOCKS.into());
        let remainder = clocks.whole() & Formula::number(u64::from(timebase.phases() - 1));
        Self {
            last_sub: Parameter::of(&last_sub),
            sub_bits: Parameter::of(&last_sub.used_bits()),
            clocks_per_tick_out_of_range: ParameterRefusal::of(
                &(outside | remainder.is_not(&Formula::number(0))),
            ),
            last_phase: Parameter::new(u64::from(timebase.phases() - 1)),
            ..Self::default()
        }
    }
}

impl Tick {
    /// Makes a counter that runs one clock ahead of [`Tick::new`]: its state in cycle 0 is that of
    /// the other in cycle 1. The phases must have at least two clocks.
    pub fn ahead(timebase: &Timebase) -> Self {
        Self { sub: Register::new(Word::from(1_u64)), ..Self::new(timebase) }
    }
}

impl Logic for Tick {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, sub, phases);
        self.sub_over.next = self.sub.q.val() == self.last_sub.val();
        self.phase_over.next = self.phases.q.val() == self.last_phase.val();

        self.sub.d.next = (self.sub.q.val() + self.one.val()) & self.sub_bits.val();
        if self.sub_over.val() {
            self.sub.d.next = self.zero.val();
            self.phases.d.next = self.phases.q.val() + self.one_phase.val();
            if self.phase_over.val() {
                self.phases.d.next = self.first_phase.val();
            }
        }
        self.phase.next = self.phases.q.val();
        self.phase_start.next = self.sub.q.val() == self.zero.val();
        self.strobe.next = self.sub_over.val() & self.phase_over.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{rising_edge, settle};

    #[test]
    fn tick_asserts_strobe_in_its_last_clock_and_phase_start_in_each_phase() {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        let mut tick = Tick::new(&timebase);
        tick.connect_all();
        for cycle in 0..200_u32 {
            tick.clock.next = false.into();
            settle(&mut tick);
            assert_eq!(tick.strobe.val(), cycle % 48 == 47, "cycle {cycle}");
            assert_eq!(tick.phase_start.val(), cycle % 3 == 0, "cycle {cycle}");
            assert_eq!(tick.phase.val().value(), u128::from(cycle % 48 / 3), "cycle {cycle}");
            tick.clock.next = true.into();
            rising_edge(&mut tick);
        }
    }

    #[test]
    fn tick_synthesizes() {
        crate::sim::assert_synthesizes(
            Tick::new(&Timebase::new(16_000_000, 1000, 1).unwrap()),
            "carrystep_tick",
        );
    }
}

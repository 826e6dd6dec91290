//! The host link: requests in, answers out (docs/protocol.md), by a little machine and its program.
//!
//! ```text
//!          .------. received .---------. put, start, home, control
//!  rx ---->|      |--------->|         |--------------------------------> engine
//!          | line |          | machine | state, room, culprits, homing
//!          |      | answer   |         |<-------------------------------- engine
//!  tx <----|      |<---------|         | facts  .-------. get, latch
//!          '------'          '---------'<-------| facts |<--------------- engine
//!                                               '-------'
//! ```
//!
//! A request lies in block RAM until its CRC has come; only then a word of it reaches the engine.

use crate::parameters::{BUILD_ID, CLOCK_HZ, ROUND_TICKS, TICK_NS, WATCHDOG_ROUNDS};
use crate::primitives::formula::Formula;
use crate::primitives::register::Input;
use crate::primitives::word::Word;
use carrystep_core::EngineBuild;
use carrystep_core::link::registers::{self, BUILD_HIGH, BUILD_LOW, WATCHDOG_TICKS};
use carrystep_core::link::{BuildId, facts, image};
use rust_hdl::prelude::*;

pub mod check;
pub mod facts;
pub mod machine;
mod sim;

pub use sim::{AnyLink, LinkSim, link};

use self::facts::Facts;
use machine::Machine;

/// The link for an engine of N axes: a byte from the line, a byte to it; its other ports are the engine's.
#[derive(LogicBlock, Default)]
pub struct Link<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// A byte has come,
    pub received_valid: Input<Bit>,
    /// this one.
    pub received: Input<Word<8>>,
    /// A byte to the host is offered until it is taken,
    pub answer_valid: Signal<Out, Bit>,
    /// this one.
    pub answer: Signal<Out, Word<8>>,
    /// It is taken in this cycle.
    pub answer_take: Input<Bit>,
    /// A word of a segment is offered,
    pub put_valid: Signal<Out, Bit>,
    /// for this axis,
    pub put_axis: Signal<Out, Word<3>>,
    /// the word of this place,
    pub put_word: Signal<Out, Word<3>>,
    /// this one.
    pub put_data: Signal<Out, Word<32>>,
    /// It is taken.
    pub put_ready: Input<Bit>,
    /// The axis of `put_axis` has room for so many segments,
    pub room: Input<Word<3>>,
    /// in this cycle.
    pub room_valid: Input<Bit>,
    /// A start is offered,
    pub start_valid: Signal<Out, Bit>,
    /// of these axes.
    pub start_mask: Signal<Out, Word<N>>,
    /// It is taken.
    pub start_ready: Input<Bit>,
    /// Resume after a stop.
    pub clear: Signal<Out, Bit>,
    /// The host's controlled stop.
    pub stop: Signal<Out, Bit>,
    /// The host has broken the segment protocol.
    pub broken: Signal<Out, Bit>,
    /// The host says anew which axes wait for their limit,
    pub home_valid: Signal<Out, Bit>,
    /// namely these.
    pub home_mask: Signal<Out, Word<N>>,
    /// The host was heard of.
    pub kick: Signal<Out, Bit>,
    /// The drivers are to be powered.
    pub enable: Signal<Out, Bit>,
    /// What is asked of the engine: of this axis,
    pub get_axis: Signal<Out, Word<3>>,
    /// this item.
    pub get_item: Signal<Out, Word<2>>,
    /// Its answer,
    pub get_data: Input<Word<32>>,
    /// in this cycle.
    pub get_valid: Input<Bit>,
    /// `get_data` is a position,
    pub latch: Input<Bit>,
    /// of this axis, which waits for its limit.
    pub latch_axis: Input<Word<3>>,
    /// A stop has been called.
    pub fault: Input<Bit>,
    /// No axis moves any more.
    pub halted: Input<Bit>,
    /// All axes are done.
    pub idle: Input<Bit>,
    /// Starts can be taken.
    pub ready: Input<Bit>,
    /// A start is armed.
    pub armed: Input<Bit>,
    /// Why.
    pub cause: Input<Word<3>>,
    /// The axes that a stop came from.
    pub culprits: Input<Word<N>>,
    /// The axes that wait for their limit.
    pub homing: Input<Word<N>>,
    machine: Machine<N>,
    facts: Facts,
}

impl<const N: usize> Link<N> {
    /// The link of this build.
    fn new(build: &EngineBuild, id: BuildId) -> Self {
        Self { machine: Machine::new(&image()), facts: Facts::new(&formulas(build, id)), ..Self::default() }
    }
}

/// What the build says of itself: address, and the number as it follows from parameters of the Verilog.
fn formulas(build: &EngineBuild, id: BuildId) -> Vec<(u8, Formula<32>)> {
    let number = |value: u64| value as u32;
    let build_id = BUILD_ID.of::<64>(id.0);
    let rounds = WATCHDOG_ROUNDS.of::<32>(build.guard.watchdog).whole();
    let silence = rounds * ROUND_TICKS.of::<32>(build.guard.round).whole();
    let formula = |(address, fact): (u8, u32)| {
        let formula = match address {
            BUILD_LOW => build_id.bits(0),
            BUILD_HIGH => build_id.bits(32),
            registers::CLOCK_HZ => CLOCK_HZ.of(number(build.timebase.clock_hz())).whole(),
            registers::TICK_NS => TICK_NS.of(number(build.timebase.tick_ns())).whole(),
            WATCHDOG_TICKS => silence.clone(),
            _ => Formula::number(fact.into()),
        };
        (address, formula)
    };
    facts(build, id).into_iter().map(formula).collect()
}

impl<const N: usize> Logic for Link<N> {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, machine, facts);
        self.machine.received.next = self.received_valid.val();
        self.machine.received_data.next = self.received.val();
        self.answer.next = self.machine.a.val();
        self.answer_valid.next = self.machine.answer_valid.val();
        self.machine.answer_take.next = self.answer_take.val();

        self.put_valid.next = self.machine.put_valid.val();
        self.put_axis.next = self.machine.a.val().get_bits::<3>(3);
        self.put_word.next = self.machine.x.val().get_bits::<3>(2);
        self.put_data.next = self.machine.put_data.val();
        self.machine.put_ready.next = self.put_ready.val();
        self.machine.room.next = self.room.val();
        self.machine.room_valid.next = self.room_valid.val();
        self.start_valid.next = self.machine.start_valid.val();
        self.start_mask.next = self.machine.a.val().get_bits::<N>(0);
        self.machine.start_ready.next = self.start_ready.val();
        self.home_valid.next = self.machine.home_valid.val();
        self.home_mask.next = self.machine.a.val().get_bits::<N>(0);
        self.clear.next = self.machine.clear.val();
        self.stop.next = self.machine.stop.val();
        self.broken.next = self.machine.broken.val();
        self.kick.next = self.machine.kick.val();
        self.enable.next = self.machine.enable.val();

        self.machine.scanned.next = self.facts.scanned.val();
        self.machine.fault.next = self.fault.val();
        self.machine.halted.next = self.halted.val();
        self.machine.idle.next = self.idle.val();
        self.machine.ready.next = self.ready.val();
        self.machine.armed.next = self.armed.val();
        self.machine.cause.next = self.cause.val();
        self.machine.culprits.next = self.culprits.val();
        self.machine.homing.next = self.homing.val();
        self.machine.facts.next = self.facts.data.val();

        self.facts.address.next = self.machine.x.val().get_bits::<7>(0);
        self.facts.get_data.next = self.get_data.val();
        self.facts.get_valid.next = self.get_valid.val();
        self.facts.latch.next = self.latch.val();
        self.facts.latch_axis.next = self.latch_axis.val();
        self.get_axis.next = self.facts.get_axis.val();
        self.get_item.next = self.facts.get_item.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;
    use carrystep_core::link::Line;
    use carrystep_core::{AXES, Build, PinTiming, StartPhase, Timebase};

    #[test]
    fn formulas_are_the_facts_of_the_build() {
        let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let mut build = EngineBuild::minimal(&build, 1);
        build.guard.watchdog = 4095;
        let id = Line::Spi.build_id(&build);
        let values: Vec<_> = formulas(&build, id).iter().map(|(at, fact)| (*at, fact.value().value() as u32)).collect();
        assert_eq!(values, facts(&build, id));
    }

    #[test]
    fn link_synthesizes() {
        let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let build = EngineBuild::minimal(&build, 1);
        let id = Line::Spi.build_id(&build);
        assert_synthesizes(Link::<6>::new(&build, id), "carrystep_link");
    }
}
